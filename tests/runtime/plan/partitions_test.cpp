#include "plan/partitions.hpp"

#include <algorithm>
#include <limits>

#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

plan::PlanOptions with_threads(int threads, std::int64_t chunk = 1024) {
  plan::PlanOptions options;
  options.threads = threads;
  options.chunk = chunk;
  return options;
}

/// A source and `count` gains of `cost_ns` in a row.
Net chain(int count, double cost_ns) {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("b0", {1000, 1});
  for (int i = 1; i <= count; ++i) {
    net.gain("b" + std::to_string(i));
    net.connect("b" + std::to_string(i - 1), "b" + std::to_string(i));
  }
  for (int i = 0; i <= count; ++i) net.type(i).cost_ns = cost_ns;
  return net;
}

/// Largest piece of the best cut with pieces of at least `least`, by trying all cuts.
double best_by_force(const std::vector<double>& costs, int parts, double least, std::size_t from = 0) {
  const double none = std::numeric_limits<double>::infinity();
  double sum = 0.0, best = none;
  for (std::size_t end = from; end < costs.size(); ++end) {
    sum += costs[end];
    if (sum < least) continue;
    if (parts == 1) {
      if (end + 1 == costs.size()) best = std::min(best, sum);
    } else {
      best = std::min(best, std::max(sum, best_by_force(costs, parts - 1, least, end + 1)));
    }
  }
  return best;
}

}  // namespace

TEST_CASE("partitions: the cut makes the largest piece as small as any cut can") {
  std::uint64_t state = 1;
  const auto next = [&] { return static_cast<double>((state = state * 6364136223846793005u + 1442695040888963407u) >> 60); };
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> costs(1 + trial % 9);
    for (double& cost : costs) cost = next();
    const int parts = 1 + trial % 4;
    const double least = trial % 3 == 0 ? 0.5 : 6.0;
    const auto starts = plan::cut(costs, parts, parts == 1 ? 0.0 : least);
    const double best = best_by_force(costs, parts, parts == 1 ? 0.0 : least);
    INFO("trial " << trial);
    REQUIRE(starts.empty() == !(best < std::numeric_limits<double>::infinity()));
    if (starts.empty()) continue;
    double largest = 0.0;
    for (std::size_t p = 0; p < starts.size(); ++p) {
      const std::size_t end = p + 1 < starts.size() ? static_cast<std::size_t>(starts[p + 1]) : costs.size();
      double sum = 0.0;
      for (auto i = static_cast<std::size_t>(starts[p]); i < end; ++i) sum += costs[i];
      largest = std::max(largest, sum);
    }
    CHECK(largest == best);
  }
}

TEST_CASE("partitions: two threads share a heavy chain, and one ring of four chunks joins them") {
  const Net net = chain(7, 100.0);
  const plan::Plan plan = net.plan(with_threads(2));
  REQUIRE(plan.partitions.size() == 2);
  CHECK(plan.partition_of == std::vector<int>{0, 0, 0, 0, 1, 1, 1, 1});
  CHECK(plan.partitions[0].cost_ns == 400.0);
  CHECK(plan.notes.empty());
  for (int i = 0; i < 8; ++i) {
    INFO("buffer " << i);
    CHECK(plan.buffers[static_cast<std::size_t>(i)].slots == (i == 3 ? 4u : 1u));
    CHECK(plan.readers[static_cast<std::size_t>(i)] == (i == 3 ? std::vector<int>{1} : std::vector<int>{}));
  }
  CHECK(plan.buffers[3].bytes == 4 * 8192);
  CHECK(plan.bytes == plan.partitions[0].arena_bytes + plan.partitions[1].arena_bytes);
  CHECK(plan.chunk_s == Approx(1.024));
  CHECK(plan.latency_s == Approx(2.048));
}

TEST_CASE("partitions: threads that would have less than 20 us a chunk are not used, and the plan says so") {
  const Net net = chain(7, 100.0);
  const plan::Plan plan = net.plan(with_threads(4, 128));  // 8 x 100 ns x 128 = 102 us
  CHECK(plan.partitions.size() == 4);
  const plan::Plan less = net.plan(with_threads(4, 64));
  CHECK(less.partitions.size() == 2);
  CHECK(less.notes ==
        std::vector<std::string>{
            "2 of 4 threads used: no cut into more gives each at least 20 us of declared work a chunk (51.2 us in all)"});
}

TEST_CASE("partitions: a loop is never cut") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {1000, 1});
  net.sum("sum");
  net.lag("plant");
  net.connect("reference", "sum.in");
  net.connect("sum", "plant");
  net.connect("plant", "sum.feedback");
  const plan::Plan plan = net.plan(with_threads(3));
  CHECK(plan.partition_of == std::vector<int>{0, 1, 1});
}

TEST_CASE("partitions: records never flow against the order of threads") {
  Net net = chain(3, 1000.0);
  net.estimator("estimator");
  net.gain("late");
  net.connect("b0", "estimator");
  net.connect("b0", "late");
  net.tell("estimator.model", "late.parameters");
  net.tell("estimator.model", "b2.parameters");
  for (int threads = 2; threads <= 4; ++threads) {
    const plan::Plan plan = net.plan(with_threads(threads));
    REQUIRE(static_cast<int>(plan.partitions.size()) == threads);
    for (const graph::MessageEdge& edge : net.phase.messages) {
      CHECK(plan.partition_of[static_cast<std::size_t>(edge.from.block)] <=
            plan.partition_of[static_cast<std::size_t>(edge.to.block)]);
    }
  }
}

TEST_CASE("latency: the budget bounds the chunk, over all threads together") {
  const Net net = chain(7, 100000.0);
  plan::PlanOptions options = with_threads(1);
  options.latency_s = 0.1;
  CHECK(net.plan(options).repetitions == 100);
  options.threads = 2;
  const plan::Plan plan = net.plan(options);
  CHECK(plan.partitions.size() == 2);
  CHECK(plan.repetitions == 50);
  CHECK(plan.latency_s == Approx(0.1));
}

TEST_CASE("latency: a budget shorter than one period is refused with both") {
  Net net = chain(1, 100.0);
  net.source("slow", {100, 1});
  plan::PlanOptions options;
  options.latency_s = 0.005;
  const auto plan = net.try_plan(options);
  REQUIRE_FALSE(plan);
  CHECK(to_string(plan.error()) == "run.latency 5 ms is shorter than the common period of all sample rates, 10 ms");
}
