#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;
using nlohmann::json;

namespace {

std::complex<double> value(const json& parts) { return {parts[0].get<double>(), parts[1].get<double>()}; }

/// The largest difference between what a bank was configured to be and what a multisine measured, at the lines that both have.
double largest_difference(const json& filter, const json& measured, int& compared) {
  const auto f = filter["arrays"]["frequency"]["data"].get<std::vector<double>>();
  const json &h = filter["arrays"]["response"]["data"], &g = measured["arrays"]["response"]["data"];
  const std::size_t count = filter["attributes"]["names"].size();
  const auto lines = measured["arrays"]["frequency"]["data"].get<std::vector<double>>();
  double worst = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const auto place = std::lower_bound(f.begin(), f.end(), lines[k] * (1 - 1e-12));
    if (place == f.end() || *place > lines[k] * (1 + 1e-12)) continue;
    ++compared;
    const auto at = static_cast<std::size_t>(place - f.begin());
    for (std::size_t i = 0; i < count; ++i) {
      worst = std::max(worst, std::abs(value(h[at * count + i]) - value(g[k * count + i])));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("a measured bank of filters is what its record and the report say") {
  const Folder folder;
  const auto ended =
      run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/measuring/filter_bank.yaml", "--out", "out"}, folder.path());
  REQUIRE(ended.exit_code == 0);
  const json results = json::parse(folder.read("out/result.json"))["results"];
  int compared = 0;
  CHECK(largest_difference(results["bands"], results["band_response"], compared) < 1e-12);
  CHECK(largest_difference(results["points"], results["point_response"], compared) < 1e-12);
  CHECK(compared > 3);
  const std::string page = folder.read("out/report.html");
  CHECK_THAT(page, Contains("Frequency response") && Contains("Impulse response") && Contains("150-300 Hz"));
}

TEST_CASE("describe tells magnitude, phase and impulse response of a filter as it is configured") {
  const auto ended =
      run_bodeflow({"describe", "filters.fir", "--set", "method=given", "--set", "coefficients=[0.5, 0.5]", "--rate", "2 kHz"});
  CHECK(ended.exit_code == 0);
  CHECK_THAT(ended.out, Contains("given taps, at 2 kHz") && Contains("1000") && Contains("0.5 0.5"));
  const auto data =
      run_bodeflow({"describe", "filters.iir", "--set", "edges=100", "--set", "order=2", "--rate", "1 kHz", "--json"});
  REQUIRE(data.exit_code == 0);
  const json record = json::parse(data.out);
  const auto h = record["arrays"]["impulse"]["data"].get<std::vector<double>>();
  // Butterworth, order 2: c^2 / (1 + sqrt 2 c + c^2), c = tan(0.1 pi).
  const double c = std::tan(0.1 * 3.14159265358979323846);
  CHECK(h[0] == Approx(c * c / (1 + std::sqrt(2) * c + c * c)).epsilon(1e-12));
  CHECK(record["attributes"]["sample_rate"] == 1000);
  const auto decimation = run_bodeflow({"describe", "filters.decimate", "--set", "factor=4", "--rate", "10 kHz"});
  CHECK(decimation.exit_code == 0);
  CHECK(decimation.err.empty());
  CHECK_THAT(decimation.out, Contains("decimation by 4, at 10 kHz") && Contains("first 16 of 209 samples"));
}

TEST_CASE("describe refuses settings that a filter cannot have, and blocks that are none") {
  const auto err = [](std::vector<std::string> words) { return run_bodeflow(std::move(words)).err; };
  CHECK_THAT(err({"describe", "filters.iir", "--set", "edges=100"}), Contains("--rate is missing"));
  CHECK_THAT(err({"describe", "filters.iir", "--set", "edges=600", "--rate", "1 kHz"}),
             Contains("edges: 600 Hz; allowed: above 0 and below the Nyquist frequency 500 Hz"));
  CHECK_THAT(err({"describe", "filters.iir", "--set", "egdes=1", "--rate", "1 kHz"}), Contains("has no parameter 'egdes'"));
  CHECK_THAT(err({"describe", "filters.gain", "--rate", "1 kHz"}), Contains("no block that tells its response"));
  CHECK_THAT(err({"describe", "filters.decimate", "--set", "factor=4", "--set", "anti_alias=false", "--rate", "1 kHz"}),
             Contains("filters.decimate filters nothing with these settings"));
  CHECK_THAT(err({"describe", "filters.iir", "--set", "edges=1", "--rate", "-1"}), Contains("expected a frequency above 0"));
}
