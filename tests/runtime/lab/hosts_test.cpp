#include "../execute/random_graph.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using execute::Outcome;

void place(Bench& bench, const std::map<std::string, std::string>& hosts) {
  for (graph::Block& block : bench.phase.blocks)
    if (const auto host = hosts.find(block.name); host != hosts.end()) block.host = host->second;
}

void check_hosts(Bench& bench, const Cut& cut = {}) {
  const Result reference = bench.run(cut);
  INFO(reference.outcome.reason);
  REQUIRE(reference.outcome.status == Outcome::Status::complete);
  const auto result = bench.run_on_hosts(cut);
  if (!result) FAIL(to_string(result.error()));
  INFO(result->outcome.reason);
  REQUIRE(result->outcome.status == Outcome::Status::complete);
  CHECK(result->same_data(reference));
  for (const graph::Block& block : bench.phase.blocks) CHECK(result->said(block.name) == reference.said(block.name));
}

TEST_CASE("hosts: a chain that leaves a host and comes back gives the same bits as in one process") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("pole", "streams.pole", {{"pole", 0.5}});
  bench.add("sum", "streams.sum");
  bench.connect("noise", "pole");
  bench.connect("noise", "sum.in");
  bench.connect("pole", "sum.feedback");
  bench.duration(5.0);
  place(bench, {{"pole", "bench"}});
  for (const Cut& cut : {Cut{1024, 1, 0, 0}, Cut{1, 1, 0, 0}, Cut{100, 2, 0, 7}}) check_hosts(bench, cut);
}

TEST_CASE("hosts: a closed loop over two hosts gives the same bits as in one process") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("sum", "streams.sum");
  bench.add("plant", "streams.pole",
            {{"pole", 0.5}, {"delay", std::int64_t{3}}, {"initial", std::vector<double>{1.0, 2.0, 3.0}}});
  bench.connect("noise", "sum.in");
  bench.connect("sum", "plant");
  bench.connect("plant", "sum.feedback");
  bench.duration(0.5);
  place(bench, {{"plant", "bench"}});
  check_hosts(bench);
  place(bench, {{"plant", ""}, {"sum", "bench"}});
  check_hosts(bench);
}

TEST_CASE("hosts: a loop over hosts without a delay between them is refused by name") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("sum", "streams.sum");
  bench.add("plant", "streams.pole", {{"pole", 0.5}, {"delay", std::int64_t{1}}});
  bench.add("gain", "streams.pole", {{"pole", 0.5}});
  bench.connect("noise", "sum.in");
  bench.connect("sum", "plant");
  bench.connect("plant", "gain");
  bench.connect("gain", "sum.feedback");
  bench.duration(0.5);
  place(bench, {{"gain", "bench"}});
  const auto result = bench.run_on_hosts();
  REQUIRE_FALSE(result);
  CHECK(to_string(result.error()).find("the loop of 'sum', 'plant', 'gain' on bench goes over hosts") != std::string::npos);
}

TEST_CASE("hosts: limits are enforced where their block lies, with the same bits as in one process") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("sum", "streams.sum");
  bench.add("plant", "streams.pole", {{"pole", 0.5}, {"delay", std::int64_t{3}}});
  bench.connect("noise", "sum.in");
  bench.connect("sum", "plant");
  bench.connect("plant", "sum.feedback");
  bench.duration(0.5);
  graph::Limit& limit = bench.limit_input("plant.in");
  limit.max = graph::Quantity{"0.2", {}};
  limit.rate = graph::Quantity{"300", {}};
  REQUIRE(bench.run().outcome.limits.at(0).violations > 100);
  place(bench, {{"plant", "bench"}});
  check_hosts(bench);

  graph::Limit& measured = bench.limit_output("plant.out");
  measured.max = graph::Quantity{"0.1", {}};
  const Result one = bench.run();
  const auto result = bench.run_on_hosts();
  REQUIRE(result);
  CHECK(one.outcome.limit == 1);
  CHECK(result->outcome.limit == 1);
  CHECK(result->outcome.reason == one.outcome.reason);
  CHECK(result->stream("plant.out") == one.stream("plant.out"));
}

TEST_CASE("hosts: a limit's time is refused where a device hears of it over the network") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("motor", "streams.pole");
  bench.add("card", "streams.gain");
  bench.connect("noise", "card");
  bench.connect("noise", "motor");
  bench.duration(0.5);
  BlockDescription device = *bench.phase.blocks[2].type;
  device.roles = {"device"};
  bench.phase.blocks[2].type = &device;
  place(bench, {{"card", "bench"}});
  graph::Limit& limit = bench.limit_output("motor.out");
  limit.max = graph::Quantity{"100", {}};
  CHECK(bench.run_on_hosts());
  limit.time_s = 10.0;
  const auto refused = bench.run_on_hosts();
  REQUIRE_FALSE(refused);
  CHECK(to_string(refused.error()).find("'motor.out' must act within 10 s, but block 'card' is on another host") !=
        std::string::npos);
  place(bench, {{"noise", "bench"}, {"motor", "bench"}});
  CHECK(bench.run_on_hosts());
}

TEST_CASE("hosts: records reach other hosts at their exact time") {
  Bench bench;
  bench.add("pulse", "messages.pulse", {{"rate", 3.0}});
  bench.add("relay", "messages.relay");
  bench.add("count", "streams.counter", {{"rate", 7.0}});
  bench.add("latch", "messages.latch");
  bench.connect("count", "latch");
  bench.tell("pulse", "relay", after(1, 7));
  bench.tell("relay", "latch.first");
  bench.tell("pulse", "latch.second", after(5, 4));
  bench.duration(10.0);
  place(bench, {{"pulse", "a"}, {"relay", "b"}});
  for (const Cut& cut : {Cut{1024, 1, 0, 0}, Cut{7, 1, 0, 0}, Cut{21, 2, 0, 2}}) check_hosts(bench, cut);
}

void check_random(std::uint32_t first, std::uint32_t last, int least) {
  int ran = 0;
  for (std::uint32_t seed = first; seed < last; ++seed) {
    RandomGraph made(seed, true);
    const Result reference = made.bench.run();
    REQUIRE(reference.outcome.status == Outcome::Status::complete);
    std::mt19937 random(seed);
    for (const Cut& cut : {Cut{1000, 1, 0, 0}, Cut{64, 3, 0, 0}, Cut{1, 1, 0, 0}}) {
      for (graph::Block& block : made.bench.phase.blocks) block.host = std::array{"", "a", "b"}[random() % 3];
      const auto result = made.bench.run_on_hosts(cut);
      if (!result) continue;  // a loop over hosts with too short a delay
      ++ran;
      INFO("seed " << seed << ", chunk " << cut.chunk << ": " << result->outcome.reason);
      REQUIRE(result->outcome.status == Outcome::Status::complete);
      CHECK(result->same_data(reference));
      for (const graph::Block& block : made.bench.phase.blocks) CHECK(result->said(block.name) == reference.said(block.name));
    }
  }
  CHECK(ran >= least);
}

TEST_CASE("hosts: random graphs on random hosts give the same bits as in one process") { check_random(0, 30, 40); }

TEST_CASE("hosts: random graphs on random hosts give the same bits as in one process many times", "[long]") {
  check_random(30, 1000, 1300);
}

}  // namespace
}  // namespace bodeflow::test
