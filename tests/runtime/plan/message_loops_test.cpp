#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

/// source -> plant -> estimator -> designer -> plant.parameters
Net adaptive(graph::Latency latency) {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("source", {1000, 1});
  net.gain("plant");
  net.estimator("estimator");
  net.designer("designer");
  net.connect("source", "plant");
  net.connect("plant", "estimator");
  net.tell("estimator.model", "designer.model");
  net.tell("designer.controller", "plant.parameters", latency);
  return net;
}

const plan::Step& loop_of(const plan::Plan& plan) {
  REQUIRE(plan.partitions[0].steps.size() == 2);
  REQUIRE(plan.partitions[0].steps[1].kind == plan::Step::Kind::cluster);
  return plan.partitions[0].steps[1];
}

std::string errors(const Net& net) {
  const auto plan = net.try_plan();
  REQUIRE_FALSE(plan);
  return to_string(plan.error());
}

}  // namespace

TEST_CASE("message loops: without latency the cycle is refused with its connections") {
  CHECK(errors(adaptive({})) ==
        "g.yaml:201:5: the loop plant.out -> estimator.in, estimator.model -> designer.model, designer.controller -> "
        "plant.parameters cannot start: give the connection designer.controller -> plant.parameters a latency");
}

TEST_CASE("message loops: a pass is not longer than the latency in samples of the consumer") {
  const Net net = adaptive({{0, 1}, 8});
  const plan::Plan plan = net.plan(256);
  CHECK(loop_of(plan).repetitions == 8);
  CHECK(text_of(net.phase, loop_of(plan)) == "plant x8, estimator x8, designer x0");
}

TEST_CASE("message loops: a latency in seconds limits the pass to whole periods within it") {
  CHECK(loop_of(adaptive({{25, 2000}, 0}).plan(256)).repetitions == 12);  // 12.5 ms at 1 kHz
}

TEST_CASE("message loops: a latency longer than the chunk does not limit it") {
  CHECK(loop_of(adaptive({{2, 1}, 0}).plan(256)).repetitions == 256);
}

TEST_CASE("message loops: a latency of less than a sample still lets the loop go round sample by sample") {
  const Net net = adaptive({{1, 4000}, 0});
  CHECK(text_of(net.phase, loop_of(net.plan(256))).substr(0, 16) == "plant, estimator");
}

TEST_CASE("message loops: one sample of latency holds in the middle of a period, too") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("source", {1000, 1});
  net.add("plant", {"in"}, {"out"}, siso(), {}, {});
  net.decimate("tenth", 10);
  net.add("estimator", {"fast", "slow"}, {},
          [](const auto&) {
            return Resolution{{}, {{10, 0, {}}, Flow{}}, {}};
          },
          {}, {"model"});
  net.connect("source", "plant");
  net.connect("plant", "tenth");
  net.connect("plant", "estimator.fast");
  net.connect("tenth", "estimator.slow");
  net.tell("estimator.model", "plant.parameters", {{0, 1}, 10});
  const plan::Plan plan = net.plan(100);
  CHECK(loop_of(plan).repetitions == 1);
  CHECK(text_of(net.phase, loop_of(plan)) == "plant x10, tenth, estimator");

  net.phase.messages[0].latency = {{0, 1}, 4};
  CHECK(
      errors(net) ==
      "g.yaml:200:5: the loop plant.out -> estimator.fast, estimator.model -> plant.parameters cannot start: the latency of the "
      "connection estimator.model -> plant.parameters, 4 ms, is too short");
}

TEST_CASE("message loops: a latency in samples needs a consumer that has samples") {
  Net net = adaptive({});
  net.phase.messages[0].latency = {{0, 1}, 3};
  CHECK(errors(net) ==
        "g.yaml:200:5: connection estimator.model -> designer.model: a latency in samples, but block 'designer' has no streams; "
        "give "
        "the latency in seconds");
}

TEST_CASE("message loops: blocks without streams may talk in a circle that has a latency") {
  Net net;
  net.designer("a");
  net.designer("b");
  net.tell("a.controller", "b.model");
  net.tell("b.controller", "a.model", {{1, 1000}, 0});
  const plan::Plan plan = net.plan(256);
  CHECK(plan.repetitions == 1);
  REQUIRE(plan.partitions[0].steps.size() == 1);
  CHECK(text_of(net.phase, plan.partitions[0].steps[0]) == "a x0, b x0");
}

TEST_CASE("message order: a block takes its turn after those that send to it, whatever the order of the file") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.designer("designer");
  net.gain("plant");
  net.estimator("estimator");
  net.source("source", {1000, 1});
  net.connect("source", "plant");
  net.connect("source", "estimator");
  net.tell("estimator.model", "designer.model");
  net.tell("designer.controller", "plant.parameters");
  CHECK(net.plan(256).order == std::vector<int>{3, 2, 0, 1});
}
