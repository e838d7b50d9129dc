// The graphs of graphs/castaldi_2002 that identify the motor.

#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Json = nlohmann::json;

namespace {

constexpr double kTruth[] = {283.02867, 11.578947, 10.565175, 0.04107158};

Json result(const Folder& folder, const std::string& graph) {
  const auto ended = run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/castaldi_2002/" + graph, "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return Json::parse(folder.read("out/result.json"))["results"];
}

double number(const Json& record, const char* array, std::size_t at) {
  return record["arrays"][array]["data"].at(at).get<double>();
}

}  // namespace

TEST_CASE("the standstill graph identifies the motor from both bands, within its deviations") {
  const Folder folder;
  const Json all = result(folder, "standstill.yaml");
  const Json& motor = all["motor"];
  CHECK(motor["attributes"]["form"] == "physical");
  CHECK(motor["attributes"]["parameter_names"] == Json{"gamma", "alpha", "Lm_beta", "sigma"});
  CHECK(motor["attributes"]["warnings"].empty());
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(i);
    CHECK(std::abs(number(motor, "parameters", i) - kTruth[i]) < 3.0 * std::sqrt(number(motor, "covariance", 5 * i)));
    CHECK(number(all["known"], "parameters", i) == Approx(kTruth[i]).epsilon(1e-6));
  }
  // Without the scheme the inductance is too small, with it less so.
  const double without = number(all["without_frisch"], "parameters", 3), with = number(all["with_frisch"], "parameters", 3);
  CHECK(without < with);
  CHECK(with < number(motor, "parameters", 3));
}

TEST_CASE("the standstill graph shows what is identifiable, and after it what follows where Ls = Lr is assumed") {
  const Folder folder;
  const auto ended =
      run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/castaldi_2002/standstill.yaml", "--out", "out"}, folder.path());
  REQUIRE(ended.exit_code == 0);
  const auto identifiable = ended.out.find("  Lr/Rr [s]"), assumed = ended.out.find("  assumption: Ls = Lr: ");
  REQUIRE(identifiable != std::string::npos);
  REQUIRE(assumed != std::string::npos);
  CHECK(identifiable < assumed);
  CHECK(ended.out.find("  Rr [ohm] ", assumed) != std::string::npos);
  const std::string page = folder.read("out/report.html");
  CHECK(page.find("Assumption: Ls = Lr: another ratio") != std::string::npos);
  CHECK(page.find("Rr [ohm]") != std::string::npos);
}

TEST_CASE("the amplitude graph stops below the level at which saturation shows", "[long]") {
  const Folder folder;
  const Json all = result(folder, "amplitude.yaml");
  const Json& linearity = all["choice.linearity"];
  CHECK(linearity["attributes"]["linear"] == false);
  CHECK(linearity["attributes"]["recommended_amplitude"] == 2.0);
  // The next phase measured with it: its noise-free lines have 2 V, so the largest |u| is twice that of 1 V lines.
  CHECK(all["measure.motor"]["attributes"]["input_amplitude"].get<double>() < 30.0);
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(i);
    CHECK(std::abs(number(all["measure.known.deviation"], "deviation_over_std", i)) < 4.0);
  }
  CHECK(std::abs(number(all["measure.too_much_known.deviation"], "deviation_over_std", 1)) > 15.0);
}

TEST_CASE("Table 3 over 100 sets on the bench: sigma as printed, right by maximum likelihood, noise right to 2 percent",
          "[long]") {
  const Folder folder;
  const Json all = result(folder, "table_3.yaml");
  const double without = number(all["table.without_frisch"], "mean", 3), with = number(all["table.with_frisch"], "mean", 3);
  CHECK(without > 0.0335);
  CHECK(without < 0.0357);
  CHECK(with > 0.036);
  CHECK(with < 0.040);
  CHECK(std::abs(with - kTruth[3]) < std::abs(without - kTruth[3]));
  const Json& likelihood = all["table.maximum_likelihood"];
  const double imposed[] = {0.71, 0.57, 0.22, 0.117};
  for (std::size_t i = 0; i < 4; ++i) {
    INFO(i);
    CHECK(std::abs(number(likelihood, "mean", i) - kTruth[i]) < 5.0 * number(likelihood, "std", i) / 10.0);
    CHECK(number(all["table.noise"], "mean", i) == Approx(imposed[i]).epsilon(0.02));
  }
}
