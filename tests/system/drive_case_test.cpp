#include <complex>
#include <fstream>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Complex = std::complex<double>;
using Json = nlohmann::json;

namespace {

/// The reference's high band at 8 V a line, dead time without compensation: response of the current to the command.
constexpr const char* kGraph = R"(bodeflow: 1
run: {duration: 6.144 s}
blocks:
  excitation: {block: generators.multisine, sample_rate: 5 kHz, period: 2560, lines: {first: 3, last: 49, step: 2}, amplitude: 8 V}
  hold: {block: filters.hold, factor: 2}
  inverter: {block: drive.inverter, pwm: 10 kHz, dc_link: 540 V, dead_time: 1.5 us}
  motor: {block: drive.induction_motor, rs: 6.6 ohm, rr: 5.5 ohm, ls: 475 mH, lr: 475 mH, lm: 454 mH}
  staircase: {block: filters.decimate, factor: 2, anti_alias: false}
  response: {block: spectrum.averaging_dft, period: 2560, skip: 10, form: known_input}
connections:
  - excitation -> hold -> inverter.reference
  - inverter.legs -> motor.legs
  - motor.current -> inverter.current
  - excitation -> response.input
  - motor.current -> staircase -> response.output
)";

Json outcome(const std::vector<std::string>& options) {
  const Folder folder;
  folder.write("drive.yaml", kGraph);
  std::vector<std::string> words{"run", "drive.yaml", "--out", "out"};
  words.insert(words.end(), options.begin(), options.end());
  const auto ended = run_bodeflow(words, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return Json::parse(folder.read("out/result.json"))["results"];
}

}  // namespace

TEST_CASE("a switching inverter and a motor in a loop of blocks give the reference response of the dead time") {
  const Json file = Json::parse(std::ifstream(BODEFLOW_TEST_DATA "/errors_in_variables/drive_cases.json"));
  const Json& expected = file["cases"]["deadtime_uncomp_switching_cmd_A4.0_8.0"]["G"];
  const Json found = outcome({})["response"]["arrays"]["response"]["data"];
  REQUIRE(found.size() == 24);
  for (std::size_t k = 0; k < 24; ++k) {
    const Complex g(found[k][0], found[k][1]), reference(expected["re"][24 + k], expected["im"][24 + k]);
    CHECK(std::abs(g - reference) < 1e-6 * std::abs(reference));
  }
}

TEST_CASE("over-modulation of an inverter is in its record and in a warning") {
  const Json report = outcome({"--set", "excitation.amplitude=60"})["inverter"]["attributes"];
  CHECK(report["limited_periods"].get<int>() > 100);
  CHECK(report["periods"].get<int>() == 61440);
  CHECK(report["linear_range"].get<double>() == Approx(540 * (0.5 - 0.03)));
}
