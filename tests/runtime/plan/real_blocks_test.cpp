#include "graph/load.hpp"
#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

/// The blocks of this build, probed in this process.
Registry& registry() {
  static Registry made([] {
    Registry::Options options;
    options.path = {BODEFLOW_BUILD_DIR "/plugins"};
    return options;
  }());
  return made;
}

graph::Phase phase_of(const std::string& text) {
  auto graph = graph::load_text(text, "g.yaml", {}, registry());
  if (!graph) FAIL(to_string(graph.error()));
  return graph->phases.at(0);
}

std::string cascade(const std::string& outer_delay) {
  return R"(bodeflow: 1
run: {duration: 8.192 s}
blocks:
  reference: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}
  speed_error: {block: filters.sum, weights: [1, -1]}
)" + outer_delay +
         R"(  hold: {block: filters.hold, factor: 10}
  current_error: {block: filters.sum, weights: [1, -1]}
  motor: {block: plants.linear, numerator: [1], denominator: [0.01, 1]}
  decimate: {block: filters.decimate, factor: 10}
connections:
  - reference -> speed_error.a
  - hold -> current_error.a
  - current_error -> motor -> decimate -> speed_error.b
  - motor -> current_error.b
)" + (outer_delay.empty() ? "  - speed_error -> hold\n" : "  - speed_error -> controller -> hold\n");
}

}  // namespace

TEST_CASE("real blocks: a 10 kHz/1 kHz cascade is planned with the inner loop inside the outer one") {
  const graph::Phase phase = phase_of(cascade("  controller: {block: filters.delay, samples: 1, initial: [0.5]}\n"));
  const auto instances = plan::instantiate(phase, registry(), std::make_shared<HostServices>());
  REQUIRE(instances);
  const auto facts = plan::establish_facts(phase, *instances);
  if (!facts) FAIL(to_string(facts.error()));
  const int motor = phase.block_index("motor"), error = phase.block_index("speed_error");
  CHECK(facts->period == Rate{1, 1000});
  CHECK(facts->blocks[static_cast<std::size_t>(motor)].firings == 81920);
  CHECK(facts->blocks[static_cast<std::size_t>(error)].firings == 8192);

  const auto plan = plan::make_plan(phase, *facts, {});
  if (!plan) FAIL(to_string(plan.error()));
  check_order_of_work(phase, *facts, *plan);
  check_memory(phase, *plan);
  std::string expected = "controller, hold";
  for (int i = 0; i < 10; ++i) expected += ", motor, current_error";
  CHECK(text_of(phase, plan->partitions[0].steps[1]) == expected + ", decimate, speed_error");
  const int buffer = plan->outputs[static_cast<std::size_t>(error)][0].buffer;
  CHECK(plan->initial[static_cast<std::size_t>(buffer)] == std::vector<double>{0.5});
}

TEST_CASE("real blocks: the same cascade without a delay in the outer loop is refused at the connection that closes it") {
  const graph::Phase phase = phase_of(cascade(""));
  const auto instances = plan::instantiate(phase, registry(), std::make_shared<HostServices>());
  REQUIRE(instances);
  const auto facts = plan::establish_facts(phase, *instances);
  REQUIRE(facts);
  const auto plan = plan::make_plan(phase, *facts, {});
  REQUIRE_FALSE(plan);
  CHECK(
      to_string(plan.error()) ==
      "g.yaml:13:31: the loop speed_error.out -> hold.in, hold.out -> current_error.a, current_error.out -> motor.in, motor.out "
      "-> "
      "decimate.in, decimate.out -> speed_error.b cannot start: it needs at least 1 more sample of delay on decimate.out -> "
      "speed_error.b, which has 0");
}

TEST_CASE("real blocks: all blocks that refuse their parameters are reported with their places") {
  const graph::Phase phase = phase_of(R"(bodeflow: 1
run: {duration: 1 s}
blocks:
  a: {block: filters.sum, weights: [1, 1, 1, 1, 1]}
  b: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}
  c: {block: filters.delay, samples: 3, initial: [1, 2]}
connections: [b -> c -> a.a, b -> a.b]
)");
  const auto instances = plan::instantiate(phase, registry(), std::make_shared<HostServices>());
  REQUIRE_FALSE(instances);
  CHECK(to_string(instances.error()) ==
        "g.yaml:4:3: block 'a': weights has 5 values, allowed: at most 4\n"
        "g.yaml:6:3: block 'c': initial has 2 values, allowed: 1, or as many as the delay has samples (3)");
}
