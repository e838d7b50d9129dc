#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {
std::string errors(const Net& net) {
  const auto facts = net.try_facts();
  REQUIRE_FALSE(facts);
  return to_string(facts.error());
}
}  // namespace

TEST_CASE("facts: rates follow hold and decimate, repetitions are the smallest whole numbers") {
  Net net;
  net.phase.run.duration_s = 8.192;
  net.source("excitation", {250, 1});
  net.hold("hold", 40);
  net.gain("inverter");
  net.decimate("decimate", 20);
  net.connect("excitation", "hold");
  net.connect("hold", "inverter");
  net.connect("inverter", "decimate");
  const plan::Facts facts = net.facts();
  CHECK(facts.period == Rate{1, 250});
  CHECK(facts.blocks[1].outputs[0].rate == Rate{10000, 1});
  CHECK(facts.blocks[2].firing_rate == Rate{10000, 1});
  CHECK(facts.blocks[3].firing_rate == Rate{500, 1});
  std::vector<std::int64_t> repetitions, firings, lengths;
  for (const auto& block : facts.blocks) {
    repetitions.push_back(block.repetitions);
    firings.push_back(block.firings);
    lengths.push_back(block.outputs[0].length);
  }
  CHECK(repetitions == std::vector<std::int64_t>{1, 1, 40, 2});
  CHECK(firings == std::vector<std::int64_t>{2048, 2048, 81920, 4096});
  CHECK(lengths == std::vector<std::int64_t>{2048, 81920, 81920, 4096});
  CHECK(facts.warnings.empty());
}

TEST_CASE("facts: unconnected parts share one period, the common multiple of theirs") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {44100, 1});
  net.source("b", {48000, 1});
  const plan::Facts facts = net.facts();
  CHECK(facts.period == Rate{1, 300});
  CHECK(facts.blocks[0].repetitions == 147);
  CHECK(facts.blocks[1].repetitions == 160);
}

TEST_CASE("facts: inputs of different rates are refused with both ports, both producers and both rates") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("inverter", {10000, 1});
  net.source("step", {1000, 1});
  net.add("motor", {"voltage", "load"}, {"speed"}, [](const auto& in) {
    return Resolution{{in[0]}, {Flow{}, Flow{}}, {Flow{}}};
  });
  net.connect("inverter", "motor.voltage");
  net.connect("step", "motor.load");
  CHECK(errors(net) ==
        "g.yaml:101:5: motor.voltage gets 10 kHz from inverter.out, motor.load gets 1 kHz from step.out; put filters.hold or "
        "filters.decimate between");
}

TEST_CASE("facts: inputs of different rates fit where a firing takes samples in that ratio") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("fast", {10000, 1});
  net.source("slow", {1000, 1});
  net.add("both", {"a", "b"}, {}, [](const auto&) { return Resolution{{}, {{10, 0, {}}, Flow{}}, {}}; });
  net.connect("fast", "both.a");
  net.connect("slow", "both.b");
  CHECK(net.facts().blocks[2].firing_rate == Rate{1000, 1});
}

TEST_CASE("facts: an output that contradicts the firings is the block's error") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1});
  net.add("b", {"in"}, {"out"}, [](const auto& in) {
    Resolution r{{in[0]}, {Flow{}}, {Flow{}}};
    r.outputs[0].rate = {2000, 1};
    return r;
  });
  net.connect("a", "b");
  CHECK(errors(net) ==
        "g.yaml:2:3: block 'b': output 'out' states 2 kHz, but fires 1000 times a second with 1 sample each: 1 kHz");
}

TEST_CASE("facts: a loop that changes the rate is refused where the rates meet") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {1000, 1});
  net.sum("sum");
  net.lag("plant");
  net.hold("hold", 2);
  net.connect("reference", "sum.in");
  net.connect("sum", "plant");
  net.connect("plant", "hold");
  net.connect("hold", "sum.feedback");
  CHECK(errors(net) ==
        "g.yaml:103:5: sum.in gets 1 kHz from reference.out, sum.feedback gets 2 kHz from hold.out; put filters.hold or "
        "filters.decimate between");
}

TEST_CASE("facts: two clock domains at one block need a resampler, unless the block is one") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("model", {1000, 1});
  net.add("adc", {}, {"out"}, [](const auto&) {
    Resolution r{{stream({1000, 1})}, {}, {Flow{}}};
    r.outputs[0].clock = "scope";
    return r;
  });
  net.sum("error");
  net.connect("model", "error.in");
  net.connect("adc", "error.feedback");
  CHECK(errors(net) ==
        "g.yaml:101:5: error.in runs on the engine's clock (model.out), error.feedback on clock 'scope' (adc.out); needs a "
        "resampler");
  net.type(2).roles = {"resampler"};
  CHECK(net.try_facts());
}

TEST_CASE("facts: a stream changes its clock domain in a resampler alone") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("model", {1000, 1});
  net.add("bridge", {"in"}, {"out"}, [](const std::vector<StreamFacts>& in) {
    Resolution r{{in[0]}, {Flow{}}, {Flow{}}};
    r.outputs[0].clock = "scope";
    return r;
  });
  net.connect("model", "bridge");
  CHECK(errors(net) ==
        "g.yaml:2:3: block 'bridge': bridge.in runs on the engine's clock, bridge.out on clock 'scope'; only a resampler takes a "
        "stream to another clock");
  net.type(1).roles = {"resampler"};
  CHECK(net.try_facts());
}

TEST_CASE("facts: an element that a port can't take is refused at the connection, and nothing is said of what follows") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.add("analytic", {}, {"out"}, [](const auto&) {
    Resolution r{{stream({1000, 1})}, {}, {Flow{}}};
    r.outputs[0].element = BF_C64;
    return r;
  });
  net.gain("filter");
  net.gain("next");
  net.type(1).ports[0].element = BF_F64;
  net.connect("analytic", "filter");
  net.connect("filter", "next");
  CHECK(errors(net) == "g.yaml:100:5: connection analytic.out -> filter.in: analytic.out gives c64, filter.in takes f64");
}

TEST_CASE("facts: all refusals of blocks are collected, each in the block's own words") {
  Net net;
  net.phase.run.duration_s = 1.0;
  const auto refuse = [](const char* text) {
    return [=](const std::vector<StreamFacts>&) -> tl::expected<Resolution, std::string> {
      return tl::unexpected(std::string(text));
    };
  };
  net.source("a", {1000, 1});
  net.add("b", {"in"}, {"out"}, refuse("needs 3 channels, got 1"));
  net.add("c", {"in"}, {}, refuse("no such line"));
  net.sink("after");
  net.connect("a", "b");
  net.connect("a", "c");
  net.connect("b", "after");
  CHECK(errors(net) == "g.yaml:2:3: block 'b': needs 3 channels, got 1\ng.yaml:3:3: block 'c': no such line");
}

TEST_CASE("facts: a block that leaves its output unknown is named") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1});
  net.add("mute", {"in"}, {"out"}, [](const auto&) { return Resolution{{StreamFacts{}}, {Flow{}}, {Flow{}}}; });
  net.sink("after");
  net.connect("a", "mute");
  net.connect("mute", "after");
  CHECK(errors(net) == "g.yaml:2:3: block 'mute': nothing is known of its output 'out': it says neither channels nor rate");
}

TEST_CASE("facts: a stream without rate, channels or samples is the block's error") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {0, 1});
  net.source("b", {1000, 1}, -1, 0);
  net.add("c", {}, {"out"}, [](const auto&) { return Resolution{{stream({1000, 1})}, {}, {{0, 0, {}}}}; });
  CHECK(errors(net) ==
        "g.yaml:1:3: block 'a': output 'out' has no sample rate\n"
        "g.yaml:2:3: block 'b': output 'out' has no channels\n"
        "g.yaml:3:3: block 'c': output 'out' gives no samples");
}

TEST_CASE("facts: a loop in which each block waits for the other is named") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.gain("controller");
  net.lag("plant");
  net.sink("after");
  net.connect("controller", "plant");
  net.connect("plant", "controller");
  net.connect("plant", "after");
  CHECK(
      errors(net) ==
      "g.yaml:1:3: the loop of 'controller', 'plant' says nothing about its streams: each block waits to know its inputs; one of "
      "them must state its output by itself or from another input");
}

TEST_CASE("facts: a loop whose facts change in each pass is an error, not an endless search") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {1000, 1});
  net.add("sum", {"in", "feedback"}, {"out"}, [](const std::vector<StreamFacts>& in) {
    Resolution r{{in[0]}, {Flow{}, Flow{}}, {Flow{}}};
    if (in[1].known) r.outputs[0].channels = in[1].channels + 1;
    return r;
  });
  net.lag("plant");
  net.connect("reference", "sum.in");
  net.connect("sum", "plant");
  net.connect("plant", "sum.feedback");
  CHECK(
      errors(net) ==
      "g.yaml:3:3: the facts of the loop of 'sum', 'plant' do not settle: each pass changes them again (plant.out was at 1 kHz)");
}

TEST_CASE("facts: notes that a loop changes in each pass are no reason to go on, and those behind the loop are its last") {
  Net net;
  net.source("reference", Rate::from_hz(1e3), 1000);
  net.sum("sum");
  const auto louder = [](const std::vector<StreamFacts>& in) {
    auto resolution = siso(1, 1, 1)(in);
    if (resolution && in[0].known) {
      const auto before = in[0].notes.find("noise.std");
      resolution->outputs[0].notes["noise.std"] = {before == in[0].notes.end() ? 1.0 : 2.0 * before->second.at(0)};
    }
    return resolution;
  };
  net.add("plant", {"in"}, {"out"}, louder);
  net.sink("meter");
  net.connect("reference", "sum.in");
  net.connect("sum", "plant");
  net.connect("plant", "sum.feedback");
  net.connect("plant", "meter");
  const auto facts = net.facts();
  CHECK(facts.blocks[3].inputs[0].notes == facts.blocks[2].outputs[0].notes);
}

TEST_CASE("facts: initial values must fit delay and channels") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1}, -1, 2);
  net.lag("b", 3, {1.0, 2.0, 3.0});
  net.connect("a", "b");
  CHECK(errors(net) == "g.yaml:2:3: block 'b': input 'in' has a delay of 3 samples and 2 channels, but 3 initial values");
}

TEST_CASE("facts: rates without a short common period are refused with the rates") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.phase.place = {"g.yaml", 1, 1};
  net.source("a", {4999999, 1});
  net.source("b", {48000, 1});
  CHECK(errors(net) ==
        "g.yaml:1:1: the sample rates have no short common period: 4.999999 MHz (a.out), 48 kHz (b.out); one period of 1 s has "
        "4999999 samples of a.out, more than 4194304; choose rates in a simple ratio");
}

TEST_CASE("facts: rates whose common period is beyond 64 bits are refused, too") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000000007, 998244353});
  net.source("b", {999999937, 999999893});
  net.source("c", {179424673, 999999883});
  CHECK(errors(net).find("their common period is beyond 64 bits; choose rates in a simple ratio") != std::string::npos);
}

TEST_CASE("facts: blocks with messages alone have neither rate nor repetitions") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1});
  net.estimator("estimator");
  net.designer("designer");
  net.connect("a", "estimator");
  net.tell("estimator.model", "designer.model");
  const plan::Facts facts = net.facts();
  CHECK(facts.blocks[2].firing_rate == Rate{});
  CHECK(facts.blocks[2].repetitions == 0);
  CHECK(facts.blocks[2].firings == -1);
}
