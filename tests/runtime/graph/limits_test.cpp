#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

const std::string kBlocks =
    "bodeflow: 1\nblocks:\n  sine: {block: generators.sine}\n  motor: {block: plants.motor}\n  same: {block: filters.through}\n"
    "connections: [sine -> motor.voltage, motor.current -> same]\n";

/// With one entry under `limits`, in line 8.
std::string limited(const std::string& entry) { return kBlocks + "limits:\n  - {" + entry + "}\n"; }

}  // namespace

TEST_CASE("graph: limits of inputs clamp, of outputs stop, unless they say otherwise") {
  const Phase phase = good(kBlocks +
                           "limits:\n"
                           "  - {signal: motor.voltage, min: -5 V, max: 5 V, rate: 100 V/s}\n"
                           "  - {signal: motor.current, channel: 0, max: 3, time: 2 ms}\n"
                           "  - {signal: motor.voltage, max: 6 V, on_violation: stop}\n"
                           "  - {signal: sine, max: 1, on_violation: warn}\n"
                           "  - {signal: same.x, side: input, max: 1}\n")
                          .phases.at(0);
  REQUIRE(phase.limits.size() == 5);
  const Limit& voltage = phase.limits[0];
  CHECK(voltage.input);
  CHECK(voltage.port == End{1, 0});
  CHECK(voltage.on_violation == OnViolation::clamp);
  CHECK(voltage.min->text == "-5 V");
  CHECK(voltage.max->text == "5 V");
  CHECK(voltage.rate->place.line == 8);
  CHECK(voltage.rate->place.column == 56);
  CHECK_FALSE(voltage.time_s);
  const Limit& current = phase.limits[1];
  CHECK_FALSE(current.input);
  CHECK(current.on_violation == OnViolation::stop);
  CHECK(current.channel == "0");
  CHECK(current.time_s == 2e-3);
  CHECK(phase.limits[2].on_violation == OnViolation::stop);
  CHECK(phase.limits[3].port == End{0, 0});
  CHECK(phase.limits[3].on_violation == OnViolation::warn);
  CHECK(phase.limits[4].input);
}

TEST_CASE("graph: limits beside phases hold in every phase that has the block, those of a phase in it") {
  const std::string blocks = "blocks: {sine: {block: generators.sine}}\n    limits: [{signal: sine, min: -1}]\n";
  const Graph graph = good("bodeflow: 1\nlimits: [{signal: sine.out, max: 1}]\nphases:\n  - name: one\n    " + blocks +
                           "  - name: two\n    " + blocks + "  - name: three\n    blocks: {other: {block: generators.sine}}\n");
  CHECK(graph.phases[0].limits.size() == 2);
  CHECK(graph.phases[1].limits.size() == 2);
  CHECK(graph.phases[2].limits.empty());
}

TEST_CASE("graph: limits survive the expanded text, with variables in them") {
  LoadOptions options;
  options.overrides = {{"most", "7 V"}};
  const Graph graph = good(
      "bodeflow: 1\nvariables: {most: 5 V}\n" + kBlocks.substr(12) + "limits:\n  - {signal: motor.voltage, max: \"${most}\"}\n",
      options);
  CHECK(graph.phases[0].limits.at(0).max->text == "7 V");
  CHECK(good(graph.expanded).phases[0].limits.at(0).max->text == "7 V");
}

TEST_CASE("graph: wrong limits are refused with their exact message") {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"max: 3", "g.yaml:8:5: limits: key 'signal' is missing: which stream?"},
      {"signal: sine", "g.yaml:8:5: limits: nothing is limited; allowed: at least one of min, max, rate"},
      {"signal: sine, maxi: 3, max: 1", "g.yaml:8:20: limits: unknown key 'maxi' (did you mean 'max'?)"},
      {"signal: sinus, max: 3", "g.yaml:8:14: limits: unknown block 'sinus'; blocks: sine, motor, same"},
      {"signal: motor, max: 3",
       "g.yaml:8:14: limits: block 'motor' (plants.motor) has several streams: name one as block.port; streams: voltage, load, "
       "current, angle"},
      {"signal: motor.curent, max: 3", "g.yaml:8:14: limits: block 'motor' has no stream 'curent' (did you mean 'current'?)"},
      {"signal: same.x, max: 3", "g.yaml:8:14: limits: 'same.x' is an input and an output; say which: side: input, side: output"},
      {"signal: motor.current, max: 3, on_violation: clamp",
       "g.yaml:8:51: limits: 'motor.current' is an output, whose samples are there already; allowed: stop, warn, or a limit on "
       "the "
       "input that takes them"},
      {"signal: sine, max: 3, on_violation: halt", "g.yaml:8:42: limits: on_violation: found 'halt', allowed: clamp, stop, warn"},
      {"signal: sine, max: 3, time: 0 s", "g.yaml:8:34: limits: time: found '0 s', allowed: a time above 0 s"},
      {"signal: sine, max: 3, time: 2 V", "g.yaml:8:34: limits: time: 2 V is a voltage; allowed: a time in s"},
      {"signal: sine, max: [3]", "g.yaml:8:25: limits: max: found a list, allowed: a number with its unit, such as 12 A"},
      {"signal: $one.sine, max: 3", "g.yaml:8:14: limits: found '$one.sine', allowed: block or block.port"},
  };
  for (const auto& [entry, expected] : cases) {
    INFO(entry);
    CHECK(problems(limited(entry)).substr(0, expected.size()) == expected);
  }
}

}  // namespace bodeflow::graph
