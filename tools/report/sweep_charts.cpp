#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/bode.hpp"
#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostCurves = kColours;
constexpr std::size_t kMostCharts = 8;

/// "gain.gain = 0.5" for a run.
std::string run_name(const Record& record, std::size_t run) {
  for (const auto& [name, array] : record.arrays)
    if (name.rfind("axis.", 0) == 0 && run < array.size()) return fmt::format("{} = {}", name.substr(5), shown(array.re[run]));
  return fmt::format("run {}", run);
}

/// The runs that are drawn: all of a few, else evenly spread ones.
std::vector<std::size_t> drawn_runs(std::size_t runs) {
  std::vector<std::size_t> drawn;
  const std::size_t count = std::min(runs, kMostCurves);
  for (std::size_t n = 0; n < count; ++n) drawn.push_back(count == runs ? n : n * (runs - 1) / (count - 1));
  return drawn;
}

/// Magnitude and phase of response (i, j) in the runs.
Chart runs_chart(const Record& record, const Array& frequency, const Array& response, std::size_t i, std::size_t j) {
  const std::size_t runs = response.shape[0], lines = response.shape[1], outputs = response.shape[2], inputs = response.shape[3];
  Chart chart;
  chart.title = fmt::format("{} / {} in {} runs", record.text_at("output_names", i, fmt::format("output {}", i + 1)),
                            record.text_at("input_names", j, fmt::format("input {}", j + 1)), runs);
  chart.name = fmt::format("{}_runs_{}_{}", record.key, i + 1, j + 1);
  chart.description = "Magnitude in decibels and phase in degrees over frequency, one curve a run.";
  chart.x_title = "Frequency [Hz]";
  Panel magnitude, phase;
  const std::string unit = response.unit.empty() || response.unit == "1" ? "" : " re 1 " + response.unit;
  magnitude.y = {Scale::decibel, 0, 1, {}, {}, fmt::format("Magnitude [dB{}]", unit)};
  magnitude.height = 270.0;
  phase.y = {Scale::degrees, 0, 1, {}, {}, "Phase [°]"};
  phase.height = 180.0;
  for (const std::size_t run : drawn_runs(runs)) {
    Series size, angle;
    size.colour = angle.colour = static_cast<int>(magnitude.series.size());
    size.name = run_name(record, run);
    std::vector<double> degrees;
    for (std::size_t k = 0; k < lines; ++k) {
      const auto g = response.at(((run * lines + k) * outputs + i) * inputs + j);
      size.x.push_back(frequency.re[run * lines + k]);
      size.y.push_back(std::abs(g) > 0.0 ? decibel(std::abs(g)) : kNaN);
      degrees.push_back(std::arg(g) * 180.0 / std::numbers::pi);
    }
    angle.x = size.x;
    angle.y = unwrapped(degrees, std::vector<bool>(lines, true));
    chart.x_logarithmic = is_logarithmic(size.x);
    magnitude.series.push_back(thinned(size, chart.x_logarithmic));
    phase.series.push_back(thinned(angle, chart.x_logarithmic));
  }
  chart.panels.push_back(std::move(magnitude));
  chart.panels.push_back(std::move(phase));
  return chart;
}

}  // namespace

void add_sweep_charts(Page& page, const Record& record, std::size_t runs) {
  const Array* frequency = record.array("frequency");
  const Array* response = record.array("response");
  if (frequency == nullptr || response == nullptr || response->shape.size() != 4 || response->size() == 0) return;
  if (frequency->shape != std::vector<std::uint64_t>{runs, response->shape[1]} || response->shape[0] != runs) return;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < response->shape[2]; ++i)
    for (std::size_t j = 0; j < response->shape[3] && drawn < kMostCharts; ++j, ++drawn)
      page.figure(runs_chart(record, *frequency, *response, i, j));
}

}  // namespace bodeflow::tools::report
