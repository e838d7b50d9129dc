#include "plan/limits.hpp"

#include <nlohmann/json.hpp>

#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

/// speed and torque at 1 kHz, in two channels with their units, through a gain into a sink.
Net bench() {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.add("drive", {}, {"feedback"}, [](const auto&) {
    StreamFacts facts = stream({1000, 1}, -1, 2);
    facts.channel_names = {"speed", "torque"};
    facts.channel_units = {"rpm", "Nm"};
    return Resolution{{facts}, {}, {Flow{}}};
  });
  net.gain("gain");
  net.sink("sink");
  net.connect("drive", "gain");
  net.connect("gain", "sink");
  return net;
}

graph::Limit& add(Net& net, bool input, graph::End port) {
  graph::Limit limit;
  limit.port = port;
  limit.input = input;
  limit.on_violation = input ? graph::OnViolation::clamp : graph::OnViolation::stop;
  limit.place = {"g.yaml", 50, 5};
  limit.channel_place = {"g.yaml", 50, 20};
  limit.time_place = {"g.yaml", 50, 60};
  return net.phase.limits.emplace_back(limit);
}

graph::Quantity at(const std::string& text, int column) { return {text, {"g.yaml", 50, column}}; }

std::string problem(const Net& net, const plan::PlanOptions& options = {}) {
  const auto plan = net.try_plan(options);
  return plan ? "no problem" : to_string(plan.error());
}

}  // namespace

TEST_CASE("limits: numbers are in the unit of the channel, rates per second") {
  Net net = bench();
  graph::Limit& limit = add(net, false, {0, 0});
  limit.channel = "speed";
  limit.min = at("-10 rad/s", 30);
  limit.max = at("1650", 40);
  limit.rate = at("100 rad/s^2", 50);
  const plan::Limit planned = net.plan(64).limits.at(0);
  CHECK(planned.channels == std::vector<std::uint32_t>{0});
  CHECK(planned.unit == "rpm");
  CHECK(planned.min == Approx(-95.4929658551));
  CHECK(planned.max == 1650.0);
  CHECK(planned.rate == Approx(954.929658551));
  CHECK(planned.latency_samples == 64);
  CHECK(planned.latency_s == Approx(0.064));
  CHECK(plan::to_text(planned) ==
        "drive.feedback, channel speed: -95.493 to 1650 rpm, changes of at most 954.93 rpm/s; stop, within 64 samples (64 ms)");
  CHECK(plan::to_json(planned)["rate_per_s"] == planned.rate);
}

TEST_CASE("limits: one at an input acts with the sample, at an output within a chunk for each thread") {
  Net net = bench();
  for (const bool input : {true, false}) {
    graph::Limit& limit = add(net, input, {1, 0});
    limit.channel = "1";
    limit.max = at("3 Nm", 30);
  }
  net.type(0).cost_ns = net.type(1).cost_ns = net.type(2).cost_ns = 1e6;
  plan::PlanOptions options;
  options.chunk = 100;
  options.threads = 2;
  const plan::Plan plan = net.plan(options);
  REQUIRE(plan.partitions.size() == 2);
  CHECK(plan.limits.at(0).latency_samples == 0);
  CHECK(plan.limits.at(0).latency_s == 0.0);
  CHECK(plan.limits.at(1).latency_samples == 200);
  CHECK(plan.limits.at(1).latency_s == Approx(0.2));
  CHECK(plan::to_text(plan.limits[0]) == "gain.in, channel torque: at most 3 Nm; clamp, from the same sample on");
  CHECK(plan::to_text(net.phase, net.facts(), plan).find("\nlimits:\n  gain.in, channel torque: at most 3 Nm; clamp, from") !=
        std::string::npos);
}

TEST_CASE("limits: a time that the plan does not keep is refused with what to change") {
  Net net = bench();
  graph::Limit& limit = add(net, false, {0, 0});
  limit.channel = "speed";
  limit.max = at("1650 rpm", 30);
  limit.time_s = 0.02;
  plan::PlanOptions options;
  options.chunk = 100;
  CHECK(problem(net, options) ==
        "g.yaml:50:60: limits: 'drive.feedback' must act within 20 ms, the plan needs 100 ms (chunks of 100 ms, 1 thread); "
        "allowed: a longer time, or run: {latency: 20 ms}");
  options.latency_s = 0.02;
  CHECK(net.plan(options).limits.at(0).latency_s == Approx(0.02));
  limit.time_s = 0.0005;
  CHECK(
      problem(net, options) ==
      "g.yaml:50:60: limits: 'drive.feedback' must act within 500 us, the plan needs 20 ms (chunks of 20 ms, 1 thread); allowed: "
      "at least 1 ms, the common period of all sample rates, with run: {latency: 1 ms}");
  net.phase.limits.clear();
  graph::Limit& input = add(net, true, {1, 0});
  input.channel = "speed";
  input.max = at("1650 rpm", 30);
  input.time_s = 1e-9;
  CHECK(problem(net, options) == "no problem");
}

TEST_CASE(
    "limits: an input that ends the run keeps its block from the sample, and the others within the latency that its time asks "
    "for") {
  Net net = bench();
  graph::Limit& limit = add(net, true, {1, 0});
  limit.channel = "speed";
  limit.max = at("1650 rpm", 30);
  limit.on_violation = graph::OnViolation::stop;
  const plan::Limit planned = net.plan(64).limits.at(0);
  CHECK(planned.latency_samples == 64);
  CHECK(planned.latency_s == Approx(0.064));
  CHECK(plan::to_text(planned) ==
        "gain.in, channel speed: at most 1650 rpm; stop, from the same sample on, other blocks within 64 samples (64 ms)");
  limit.time_s = 0.02;
  CHECK(problem(net).substr(0, 53) == "g.yaml:50:60: limits: 'gain.in' must act within 20 ms");
}

TEST_CASE("limits: those of one port start at a value that all of them allow, and are refused where there is none") {
  Net net = bench();
  for (const char* channel : {"speed", "torque", "speed", "speed"}) add(net, true, {1, 0}).channel = channel;
  auto& limits = net.phase.limits;
  limits[0].min = at("300 rpm", 30);
  limits[1].min = at("-7 Nm", 30);
  limits[1].max = at("-2 Nm", 40);
  limits[2].rate = at("1 rpm/s", 30);
  limits[3].max = at("-5 rpm", 30);
  limits[3].on_violation = graph::OnViolation::warn;  // changes nothing for the others
  const plan::Plan plan = net.plan(64);
  CHECK(plan.limits[0].start == std::vector<double>{300.0});
  CHECK(plan.limits[1].start == std::vector<double>{-2.0});
  CHECK(plan.limits[2].start == std::vector<double>{300.0});
  limits[3].on_violation = graph::OnViolation::stop;
  limits[3].place.line = 51;
  CHECK(problem(net) ==
        "g.yaml:51:5: limits: no value of 'gain.in' is at most -5 rpm and, as line 50 wants it, at least 300 rpm");
}

TEST_CASE("limits: wrong channels, units and bounds are refused where they stand") {
  struct Case {
    std::string channel, min, max, rate, expected;
  };
  const std::vector<Case> cases = {
      {"sped", "", "1", "",
       "g.yaml:50:20: limits: 'drive.feedback' has no channel 'sped' (did you mean 'speed'?); channels: speed, torque"},
      {"2", "", "1", "", "g.yaml:50:20: limits: 'drive.feedback' has no channel '2'; channels: speed, torque"},
      {"", "", "1", "",
       "g.yaml:50:5: limits: 'drive.feedback' has channels of different units (rpm, Nm); allowed: a limit for each, with "
       "'channel'"},
      {"speed", "", "3 A", "",
       "g.yaml:50:40: limits: 'drive.feedback': max: 3 A is a current; allowed: an angular frequency in rpm"},
      {"speed", "", "fast", "", "g.yaml:50:40: limits: 'drive.feedback': max: "},
      {"speed", "", "", "3 rpm",
       "g.yaml:50:50: limits: 'drive.feedback': rate: 3 rpm is an angular frequency; allowed: an angular acceleration in rpm/s"},
      {"speed", "3", "1", "", "g.yaml:50:30: limits: 'drive.feedback' has min 3 rpm above max 1 rpm"},
      {"speed", "", "", "-2 rpm/s", "g.yaml:50:50: limits: 'drive.feedback' has rate '-2 rpm/s'; allowed: above 0"},
  };
  for (const Case& one : cases) {
    Net net = bench();
    graph::Limit& limit = add(net, false, {0, 0});
    limit.channel = one.channel;
    if (!one.min.empty()) limit.min = at(one.min, 30);
    if (!one.max.empty()) limit.max = at(one.max, 40);
    if (!one.rate.empty()) limit.rate = at(one.rate, 50);
    CHECK(problem(net).substr(0, one.expected.size()) == one.expected);
  }
}

TEST_CASE("limits: a stream that is not there or complex is refused") {
  Net net = bench();
  net.sum("sum");
  net.source("other", {1000, 1});
  net.connect("other", "sum.in");
  add(net, true, {net.phase.block_index("sum"), 1}).max = at("1", 30);
  CHECK(problem(net) == "g.yaml:50:5: limits: 'sum.feedback' is not connected: there is nothing to limit");

  Net complex;
  complex.phase.run.duration_s = 1.0;
  complex.add("phasor", {}, {"out"}, [](const auto&) {
    StreamFacts facts = stream({1000, 1});
    facts.element = BF_C64;
    return Resolution{{facts}, {}, {Flow{}}};
  });
  add(complex, false, {0, 0}).max = at("1", 30);
  CHECK(problem(complex) == "g.yaml:50:5: limits: 'phasor.out' is complex; allowed: real streams");
}
