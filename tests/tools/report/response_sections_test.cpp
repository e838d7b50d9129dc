// Sections of records about frequency responses: what a fit leaves, line by line and band by band, and the change between two.

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "report/report.hpp"
#include "system/command.hpp"
#include "tools/report/run_results.hpp"

using namespace bodeflow;
using namespace bodeflow::tools::report;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;
using test::Folder;

namespace {

constexpr std::size_t kLines = 60;

double hertz(std::size_t k) { return std::pow(10.0, static_cast<double>(k) / 20.0); }

/// A mode of that frequency, damping 2 %.
std::complex<double> mode(double f, double own) {
  const double x = f / own;
  return 1.0 / std::complex<double>(1.0 - x * x, 0.04 * x);
}

ordered_json array_of(const std::string& unit, const std::vector<std::size_t>& shape, ordered_json data) {
  return {{"unit", unit}, {"shape", shape}, {"data", std::move(data)}};
}

template <class F>
ordered_json numbers(std::size_t count, F value) {
  ordered_json list = ordered_json::array();
  for (std::size_t n = 0; n < count; ++n) list.push_back(value(n));
  return list;
}

ordered_json pair_of(std::complex<double> z) { return {z.real(), z.imag()}; }

/// What two bands, each a mode and 1 % too large, leave of their sum.
ordered_json residual_of_bands() {
  const auto band = [](std::size_t b, std::size_t k) { return 1.01 * mode(hertz(k), b == 0 ? 5.0 : 200.0); };
  ordered_json record{{"type", "residual"},
                      {"attributes",
                       {{"method", "sanathanan_koerner.multi_band"},
                        {"output_names", {"angle"}},
                        {"input_name", "current"},
                        {"input_names", {"current"}}}}};
  record["arrays"] = {
      {"frequency", array_of("Hz", {kLines}, numbers(kLines, hertz))},
      {"response",
       array_of("rad/A", {kLines, 1}, numbers(kLines, [&](std::size_t k) { return pair_of((band(0, k) + band(1, k)) / 1.01); }))},
      {"model_response",
       array_of("rad/A", {kLines, 1}, numbers(kLines, [&](std::size_t k) { return pair_of(band(0, k) + band(1, k)); }))},
      {"band_edges", array_of("Hz", {2, 2}, {1.0, 30.0, 30.0, 1000.0})},
      {"band_response", array_of("rad/A", {2, kLines, 1},
                                 numbers(2 * kLines, [&](std::size_t n) { return pair_of(band(n / kLines, n % kLines)); }))}};
  return record;
}

/// A mode at 20 Hz that has moved to 21 Hz, one entry, two bands.
ordered_json change() {
  ordered_json record{{"type", "change"},
                      {"attributes",
                       {{"conclusion", "changed in 10 to 100 Hz"},
                        {"scatter", "0.5 % by repeat tests"},
                        {"confidence", 0.99},
                        {"entries", {"phase A"}},
                        {"entry_verdicts", {"changed"}},
                        {"band_verdicts", {"unchanged", "changed"}},
                        {"mode_status", {"moved", "new"}},
                        {"dl_911", {"obvious"}}}}};
  const auto before = [](std::size_t k) { return mode(hertz(k), 20.0); };
  const auto after = [](std::size_t k) { return mode(hertz(k), 21.0); };
  record["arrays"] = {
      {"frequency", array_of("Hz", {kLines}, numbers(kLines, hertz))},
      {"before", array_of("V/V", {kLines, 1}, numbers(kLines, [&](std::size_t k) { return pair_of(before(k)); }))},
      {"after", array_of("V/V", {kLines, 1}, numbers(kLines, [&](std::size_t k) { return pair_of(after(k)); }))},
      {"change_deviation", array_of("V/V", {kLines, 1}, numbers(kLines, [](std::size_t) { return 0.002; }))},
      {"band_low", array_of("Hz", {2}, {1.0, 10.0})},
      {"band_high", array_of("Hz", {2}, {10.0, 100.0})},
      {"band_change", array_of("", {1, 2}, {0.001, 0.42})},
      {"band_probability", array_of("", {1, 2}, {0.37, 1e-9})},
      {"band_detectable", array_of("", {1, 2}, {0.012, nullptr})},
      {"band_correlation", array_of("", {1, 2}, {0.99991, 0.8123})},
      {"band_factor", array_of("", {1, 2}, {4.05, 0.727})},
      {"correlation", array_of("", {1}, {0.9321})},
      {"factor", array_of("", {1}, {1.17})},
      {"dl_911_factors", array_of("", {1, 3}, {0.61, 1.52, 2.43})},
      {"mode_entry", array_of("", {2}, {0, 0})},
      {"mode_frequency_before", array_of("Hz", {2}, {20.0, nullptr})},
      {"mode_frequency_after", array_of("Hz", {2}, {21.0, 77.7})},
      {"mode_damping_before", array_of("", {2}, {0.02, nullptr})},
      {"mode_damping_after", array_of("", {2}, {0.021, 0.03})},
      {"mode_frequency_shift", array_of("", {2}, {0.05, nullptr})},
      {"mode_frequency_shift_deviation", array_of("", {2}, {0.001, nullptr})}};
  return record;
}

struct Written {
  std::string page;
  std::vector<std::string> plots;
};

Written written(const std::string& name, const ordered_json& record) {
  const Folder folder;
  folder.write("result.json", test::result_with({{name, record}}).dump());
  const auto report = write_report({folder.path(), {}}, Registry::with({}));
  REQUIRE(report);
  Written w{folder.read("report.html"), {}};
  for (const auto& plot : report->plots) w.plots.push_back(plot.filename().string());
  return w;
}

bool has(const std::vector<std::string>& files, const std::string& file) {
  return std::find(files.begin(), files.end(), file) != files.end();
}

}  // namespace

TEST_CASE("report: what a fit leaves stands in per cent of the data and in a table") {
  ordered_json record = residual_of_bands();
  record["arrays"].erase("band_edges");
  const Written w = written("left", record);
  CHECK_THAT(w.page, Contains("Percentage error"));
  CHECK_THAT(w.page, Contains("angle / current"));
  CHECK_THAT(w.page, Contains("1 %"));
  CHECK(has(w.plots, "left_percent_1.svg"));
  CHECK_THAT(w.page, !Contains("Band by band"));
}

TEST_CASE("report: a sum of bands has the display of six panels for each band") {
  const Written w = written("left", residual_of_bands());
  CHECK_THAT(w.page, Contains("Band by band"));
  CHECK_THAT(w.page, Contains("Band 1: 1 to 30 Hz"));
  CHECK_THAT(w.page, Contains("Band 2: 30 to 1000 Hz"));
  for (const char* file : {"left_band_1_1.svg", "left_band_1_2.svg", "left_band_1_3.svg", "left_band_2_3.svg"})
    CHECK(has(w.plots, file));
  CHECK(w.page.find("NaN") == std::string::npos);
}

TEST_CASE("report: a residual whose arrays do not fit each other is shown as any record is") {
  ordered_json record = residual_of_bands();
  record["arrays"]["response"]["shape"] = {kLines / 2, 2};
  const Written w = written("left", record);
  CHECK_THAT(w.page, !Contains("Percentage error"));
  CHECK_THAT(w.page, Contains("id=\"left\""));
}

TEST_CASE("report: a change stands with verdict and bands and resonances and standard") {
  const Written w = written("difference", change());
  for (const char* text : {"Verdict: changed in 10 to 100 Hz.", "Scatter of repeat tests: 0.5 % by repeat tests.",
                           "phase A: changed", "Bands of phase A", "42 %", "below 0.01 %", "1.2 %", "moved", "new", "5 %",
                           "0.2 %", "77.7", "deformation obvious", "0.61, 1.52, 2.43", "confidence of 99 %"}) {
    INFO(text);
    CHECK(w.page.find(text) != std::string::npos);
  }
  CHECK(has(w.plots, "difference_change_1.svg"));
  CHECK(w.page.find("NaN") == std::string::npos);
}

TEST_CASE("report: a change without bands is shown as any record is") {
  ordered_json record = change();
  record["arrays"].erase("band_change");
  const Written w = written("difference", record);
  CHECK_THAT(w.page, !Contains("Verdict: changed"));
  CHECK_THAT(w.page, Contains("id=\"difference\""));
}
