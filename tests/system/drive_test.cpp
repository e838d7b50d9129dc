#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

Json result(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.begin(), "run");
  words.insert(words.end(), {"--out", "out"});
  const auto ended = run_bodeflow(words, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return Json::parse(folder.read("out/result.json"))["results"];
}

}  // namespace

TEST_CASE("the classical tests find Table 1 of Castaldi 2002 again, and skin effect in the resistance of a locked rotor") {
  const Folder folder;
  const Json all = result(folder, {BODEFLOW_SOURCE_DIR "/graphs/castaldi_2002/classical_tests.yaml"});
  // Rs, Rr, Ls, Lr, Lm, sigma, beta, alpha, gamma; Table 1 gives three digits of the last four.
  const Json& found = all["tests.motor"]["arrays"]["parameters"]["data"];
  const Json& published = all["tests.motor"]["arrays"]["published_parameters"]["data"];
  REQUIRE(found.size() == 9);
  for (std::size_t k = 0; k < 9; ++k) {
    INFO(k);
    CHECK(found[k].get<double>() == Approx(published[k].get<double>()).epsilon(k < 5 ? 1e-4 : 2e-3));
  }
  CHECK(all["tests.motor"]["attributes"]["form"] == "physical");
  // The rotor has 3.5 ohm at low frequencies.
  CHECK(all["bar_tests.motor"]["arrays"]["parameters"]["data"][1].get<double>() == Approx(5.5).epsilon(0.02));
  CHECK(all["slow_tests.motor"]["arrays"]["parameters"]["data"][1].get<double>() == Approx(3.5).epsilon(0.02));
}

TEST_CASE("a hidden effect drawn in one phase acts in the next, and nothing but its record tells it") {
  const Folder folder;
  folder.write("graph.yaml", R"y(bodeflow: 1
run: {seed: 5}
phases:
  - name: hide
    blocks: {secret: {block: drive.hidden_effect, effects: [offset], size: {offset: [250 mA, 250 mA]}, parameter_spread: 8 %}}
  - name: measure
    run: {duration: 0.5 s}
    blocks:
      supply: {block: drive.supply, sample_rate: 10 kHz, voltage: 0 V, frequency: 0}
      motor: {block: drive.induction_motor, rs: 6.6 ohm, rr: 5.5 ohm, ls: 475 mH, lr: 475 mH, lm: 454 mH, standstill: true}
      sensor: {block: drive.current_sensor}
      meter: {block: drive.power_meter, frequency: 0}
      pass: {block: drive.voltage_sensor}
    connections:
      - supply -> motor.voltage
      - motor.current -> sensor -> meter.current
      - supply -> pass -> meter.voltage
      - $hide.secret -> sensor.properties
      - $hide.secret -> motor.properties
      - $hide.secret -> pass.properties
)y");
  const Json all = result(folder, {"graph.yaml"});
  const Json& secret = all["hide.secret"]["attributes"];
  CHECK(secret["effect"] == "offset");
  CHECK(secret["current_offset"].get<double>() == Approx(0.25));
  CHECK(std::abs(secret["rs"].get<double>() / 6.6 - 1) <= 0.08);
  CHECK(all["measure.meter"]["attributes"]["current"].get<double>() == Approx(0.25).epsilon(1e-12));
}

TEST_CASE("a graph that lists an effect which no bench has is refused with the effects there are") {
  const Folder folder;
  folder.write("graph.yaml", R"y(bodeflow: 1
phases:
  - name: hide
    blocks: {secret: {block: drive.hidden_effect, effects: [backlash]}}
)y");
  const auto ended = run_bodeflow({"check", "graph.yaml"}, folder.path());
  CHECK(ended.exit_code == 3);
  CHECK_THAT(ended.err, Contains("unknown effect 'backlash', allowed: none, delay, dead_time, saturation"));
}
