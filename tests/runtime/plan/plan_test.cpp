#include <algorithm>
#include <nlohmann/json.hpp>

#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

std::uint64_t step(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return state >> 33;
}

/// A graph of random wiring over three rates with small loops, and `feedbacks` connections back from anywhere.
Net random_net(std::uint64_t seed, int feedbacks = 0) {
  Net net;
  net.phase.run.duration_s = 1.0;
  std::uint64_t state = seed;
  const auto pick = [&](std::uint64_t n) { return step(state) % n; };
  std::vector<std::vector<std::string>> by_rate(3);  // names of blocks with an output at 1, 2 and 10 kHz
  const std::int64_t hz[] = {1000, 2000, 10000};
  for (int i = 0; i < 3; ++i) {
    const std::string name = "s" + std::to_string(i);
    net.source(name, {hz[i], 1});
    by_rate[static_cast<std::size_t>(i)].push_back(name);
  }
  for (int i = 0; i < 30; ++i) {
    const std::string name = "b" + std::to_string(i);
    const std::size_t rate = pick(3);
    const auto any = [&](std::size_t r) { return by_rate[r][pick(by_rate[r].size())]; };
    std::size_t out = rate;
    switch (pick(6)) {
      case 0:
        net.gain(name);
        break;
      case 1:
        net.lag(name, 1 + pick(20));
        break;
      case 2:
        out = 2;
        if (rate == 2) {
          net.gain(name);
        } else {
          net.hold(name, rate == 0 ? 10 : 5);
        }
        break;
      case 3:
        out = 0;
        if (rate == 0) {
          net.gain(name);
        } else {
          net.decimate(name, rate == 1 ? 2 : 10);
        }
        break;
      case 4: {  // a loop of its own: sum -> lag -> sum
        net.sum(name);
        net.lag(name + "_lag", 1 + pick(4));
        net.connect(any(rate), name + ".in");
        net.connect(name, name + "_lag");
        net.connect(name + "_lag", name + ".feedback");
        by_rate[out].push_back(name + "_lag");
        continue;
      }
      default: {
        net.sum(name);
        net.connect(any(rate), name + ".in");
        net.connect(any(rate), name + ".feedback");
        by_rate[out].push_back(name);
        continue;
      }
    }
    net.connect(any(rate), name);
    by_rate[out].push_back(name);
  }
  for (int i = 0; i < feedbacks; ++i) {
    const std::string name = "f" + std::to_string(i);
    const std::size_t rate = pick(3);
    net.sum(name);
    net.connect(by_rate[rate][pick(by_rate[rate].size())], name + ".in");
    net.connect(by_rate[rate][pick(by_rate[rate].size())], name + ".feedback");
    // Somebody reads it instead of what it read before.
    const int block = net.phase.block_index(name);
    std::vector<std::size_t> same;
    for (std::size_t e = 0; e + 2 < net.phase.streams.size(); ++e) {
      const auto& names = by_rate[rate];
      const std::string& from = net.phase.blocks[static_cast<std::size_t>(net.phase.streams[e].from.block)].name;
      if (std::find(names.begin(), names.end(), from) != names.end()) same.push_back(e);
    }
    if (!same.empty()) net.phase.streams[same[pick(same.size())]].from = {block, 0};
    by_rate[rate].push_back(name);
  }
  for (std::size_t i = 0; i < net.phase.blocks.size(); ++i) net.type(static_cast<int>(i)).in_place = pick(2) == 0;
  return net;
}

}  // namespace

TEST_CASE("plan: random graphs with loops run in order and in memory of their own, for every chunk and number of threads") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    INFO("seed " << seed);
    const Net net = random_net(seed);
    for (const int threads : {1, 2, 3}) {
      for (const std::int64_t chunk : {1, 64, 1000}) {
        plan::PlanOptions options;
        options.threads = threads;
        options.chunk = chunk;
        net.plan(options);  // checks
      }
    }
  }
}

TEST_CASE("plan: a deadlocked graph runs once it has the delays that the refusal asks for") {
  int deadlocks = 0, loops = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    Net net = random_net(seed, 6);
    if (!net.try_facts()) continue;  // a loop that nothing drives has no facts
    auto plan = net.try_plan();
    if (!plan) {
      ++deadlocks;
      for (const Problem& problem : plan.error()) {
        INFO(to_string(problem));
        const std::size_t at = problem.text.find("at least ");
        REQUIRE(at != std::string::npos);
        const auto edge = std::find_if(net.phase.streams.begin(), net.phase.streams.end(),
                                       [&](const graph::StreamEdge& e) { return e.place.line == problem.place.line; });
        net.more_delay.emplace_back(edge->to, std::stoull(problem.text.substr(at + 9)));
      }
      // With the samples asked for less one on the last connection, it still cannot start.
      --net.more_delay.back().second;
      CHECK_FALSE(net.try_plan());
      ++net.more_delay.back().second;
    }
    const plan::Plan repaired = net.plan();  // checks
    for (const plan::Step& step : repaired.partitions[0].steps) loops += step.kind == plan::Step::Kind::cluster;
  }
  CHECK(deadlocks > 10);
  CHECK(loops > 100);
}

TEST_CASE("plan: the same input gives the same plan") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Net a = random_net(seed), b = random_net(seed);
    plan::PlanOptions options;
    options.threads = 2;
    CHECK(plan::to_json(a.phase, a.facts(), a.plan(options)).dump() == plan::to_json(b.phase, b.facts(), b.plan(options)).dump());
  }
}

TEST_CASE("plan: fan-out calls each block once, ties in the order of the file") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.sink("z");
  net.gain("c");
  net.gain("b");
  net.source("a", {1000, 1});
  net.connect("a", "b");
  net.connect("a", "c");
  net.connect("b", "z");
  const plan::Plan plan = net.plan(64);
  CHECK(plan.order == std::vector<int>{3, 1, 2, 0});
  CHECK(plan.partitions[0].steps.size() == 4);
}

TEST_CASE("plan: the chunk counts samples of the fastest stream, and one period is the least") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {250, 1});
  net.hold("b", 40);
  net.connect("a", "b");
  CHECK(net.plan(1024).repetitions == 25);
  CHECK(net.plan(1024).chunk_s == Approx(0.1));
  CHECK(net.plan(1).repetitions == 1);
  CHECK(net.plan(1).buffers[1].capacity == 40);
}

TEST_CASE("plan: a phase of messages alone has one repetition and no period") {
  Net net;
  net.designer("a");
  net.designer("b");
  net.tell("a.controller", "b.model");
  plan::PlanOptions options;
  options.threads = 2;
  options.latency_s = 0.001;
  const plan::Plan plan = net.plan(options);
  CHECK(plan.repetitions == 1);
  CHECK(plan.chunk_s == 0.0);
  CHECK(plan.bytes == 0);
  CHECK(plan.partitions.size() == 1);
  CHECK(plan.order == std::vector<int>{0, 1});
}

TEST_CASE("plan: five hundred blocks with fan-out need little more memory than they have streams at once") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("b0", {1000, 1});
  for (int i = 1; i < 500; ++i) {
    net.gain("b" + std::to_string(i));
    net.connect("b" + std::to_string(i % 5 == 0 ? i - 1 : i - i % 5), "b" + std::to_string(i));
  }
  const plan::Plan plan = net.plan(1024);
  CHECK(plan.order.size() == 500);
  CHECK(plan.bytes <= 3 * 8192);
}
