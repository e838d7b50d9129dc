#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

/// reference -> sum -> controller -> plant -> sum, the plant's input being delayed.
Net single_loop(std::uint64_t delay) {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {10000, 1});
  net.sum("sum");
  net.gain("controller");
  net.lag("plant", delay);
  net.sink("scope");
  net.connect("reference", "sum.in");
  net.connect("sum", "controller");
  net.connect("controller", "plant");
  net.connect("plant", "sum.feedback");
  net.connect("plant", "scope");
  return net;
}

/// A 1 kHz speed loop around a 10 kHz current loop.
Net cascade(std::uint64_t outer_delay, std::uint64_t inner_delay = 1) {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {1000, 1});
  net.sum("speed_error");
  net.lag("speed_controller", outer_delay);
  net.hold("hold", 10);
  net.sum("current_error");
  net.gain("current_controller");
  net.lag("motor", inner_delay);
  net.decimate("decimate", 10);
  net.connect("reference", "speed_error.in");
  net.connect("speed_error", "speed_controller");
  net.connect("speed_controller", "hold");
  net.connect("hold", "current_error.in");
  net.connect("current_error", "current_controller");
  net.connect("current_controller", "motor");
  net.connect("motor", "current_error.feedback");
  net.connect("motor", "decimate");
  net.connect("decimate", "speed_error.feedback");
  return net;
}

const plan::Step& loop_of(const plan::Plan& plan) {
  for (const plan::Step& step : plan.partitions[0].steps) {
    if (step.kind == plan::Step::Kind::cluster) return step;
  }
  FAIL("the plan has no loop");
  return plan.partitions[0].steps[0];
}

std::string errors(const Net& net) {
  const auto plan = net.try_plan();
  REQUIRE_FALSE(plan);
  return to_string(plan.error());
}

}  // namespace

TEST_CASE("loops: a loop with one sample of delay goes round sample by sample, the strictly proper block first") {
  const Net net = single_loop(1);
  const plan::Plan plan = net.plan(256);
  const plan::Step& loop = loop_of(plan);
  CHECK(text_of(net.phase, loop) == "plant, sum, controller");
  CHECK(loop.repetitions == 1);
  CHECK(loop.parts == 1);
  CHECK(plan.repetitions == 256);
  CHECK(plan.order == std::vector<int>{0, 3, 1, 2, 4});
  REQUIRE(plan.partitions[0].steps.size() == 3);
  CHECK(plan.partitions[0].steps[0].block == 0);
  CHECK(plan.partitions[0].steps[2].block == 4);
}

TEST_CASE("loops: a pass is as long as the delay") {
  const Net net = single_loop(4);
  const plan::Plan plan = net.plan(256);
  CHECK(text_of(net.phase, loop_of(plan)) == "plant x4, sum x4, controller x4");
  CHECK(loop_of(plan).repetitions == 4);
  CHECK(loop_of(net.plan(3)).repetitions == 3);
}

TEST_CASE("loops: of several loops through one block the shortest delay sets the pass") {
  Net net = single_loop(6);
  net.lag("observer", 2);
  net.sum("corrected");
  net.phase.streams.erase(net.phase.streams.begin() + 2);  // controller -> plant
  net.connect("controller", "corrected.in");
  net.connect("controller", "observer");
  net.connect("corrected", "plant");
  net.connect("observer", "corrected.feedback");
  const plan::Plan plan = net.plan(256);
  CHECK(loop_of(plan).repetitions == 6);  // the observer's delay lies in no loop of its own
}

TEST_CASE("loops: a block that reads its own output waits for it sample by sample") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.add("oscillator", {"in"}, {"out"}, [](const auto&) {
    return Resolution{{stream({1000, 1})}, {{1, 2, {0.0, 1.0}}}, {Flow{}}};
  });
  net.connect("oscillator", "oscillator");
  const plan::Plan plan = net.plan(64);
  CHECK(text_of(net.phase, loop_of(plan)) == "oscillator x2");
  CHECK(plan.initial[0] == std::vector<double>{0.0, 1.0});
}

TEST_CASE("loops: a loop at the fast rate keeps its own short schedule beside slower streams") {
  Net net = single_loop(4);
  net.source("slow", {1000, 1});
  const plan::Plan plan = net.plan(1000);
  CHECK(plan.repetitions == 100);
  CHECK(text_of(net.phase, loop_of(plan)) == "plant x4, sum x4, controller x4");
  CHECK(loop_of(plan).repetitions == 4);
  CHECK(loop_of(plan).parts == 10);
}

TEST_CASE("loops: a cascade of 1 kHz around 10 kHz has one schedule with the inner loop in it") {
  const Net net = cascade(1);
  const plan::Plan plan = net.plan(1000);
  CHECK(plan.repetitions == 100);
  std::string expected = "speed_controller, hold";
  for (int i = 0; i < 10; ++i) expected += ", motor, current_error, current_controller";
  expected += ", decimate, speed_error";
  const plan::Step& loop = loop_of(plan);
  CHECK(text_of(net.phase, loop) == expected);
  CHECK(loop.repetitions == 1);
  CHECK(loop.parts == 1);
  CHECK(plan.order == std::vector<int>{0, 2, 3, 6, 4, 5, 7, 1});
}

TEST_CASE("loops: a loop without delay names its cycle, the missing samples and the edge") {
  CHECK(errors(single_loop(0)) ==
        "g.yaml:103:5: the loop sum.out -> controller.in, controller.out -> plant.in, plant.out -> sum.feedback cannot start: it "
        "needs at least 1 more sample of delay on plant.out -> sum.feedback, which has 0");
}

TEST_CASE("loops: the outer loop of a cascade lacks one sample at the slow rate") {
  CHECK(errors(cascade(0)) ==
        "g.yaml:108:5: the loop speed_error.out -> speed_controller.in, speed_controller.out -> hold.in, hold.out -> "
        "current_error.in, current_error.out -> current_controller.in, current_controller.out -> motor.in, motor.out -> "
        "decimate.in, "
        "decimate.out -> speed_error.feedback cannot start: it needs at least 1 more sample of delay on decimate.out -> "
        "speed_error.feedback, which has 0");
}

TEST_CASE("loops: every deadlocked loop is reported") {
  Net net = cascade(0, 0);
  const auto plan = net.try_plan();
  REQUIRE_FALSE(plan);
  REQUIRE(plan.error().size() == 2);
  CHECK(
      to_string(plan.error()).find("needs at least 1 more sample of delay on motor.out -> current_error.feedback, which has 0") !=
      std::string::npos);
  CHECK(to_string(plan.error())
            .find("needs at least 1 more sample of delay on decimate.out -> speed_error.feedback, which has 0") !=
        std::string::npos);
}

TEST_CASE("loops: a delay that is too short for a frame says how many samples are missing") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {1000, 1});
  net.sum("sum");
  net.add("frames", {"in"}, {"out"}, siso(8, 8, 3));
  net.connect("reference", "sum.in");
  net.connect("sum", "frames");
  net.connect("frames", "sum.feedback");
  CHECK(
      errors(net) ==
      "g.yaml:102:5: the loop sum.out -> frames.in, frames.out -> sum.feedback cannot start: it needs at least 5 more samples of "
      "delay on frames.out -> sum.feedback, which has 0");
}

TEST_CASE("loops: an edge with delay in no loop makes no loop") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1});
  net.lag("b", 5);
  net.gain("c");
  net.connect("a", "b");
  net.connect("b", "c");
  const plan::Plan plan = net.plan(64);
  CHECK(plan.partitions[0].steps.size() == 3);
  CHECK(plan.order == std::vector<int>{0, 1, 2});
  CHECK(plan.buffers[0].history == 5);
}
