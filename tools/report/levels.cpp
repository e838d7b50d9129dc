#include "report/levels.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/bode.hpp"
#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

/// sqrt of a variance of the pair over frequency.
Series deviation(const Response& response, std::size_t i, std::size_t j, const Array& variance, const std::string& name,
                 int colour) {
  Series series;
  series.name = name;
  series.colour = colour;
  series.x = response.frequency;
  for (std::size_t k = 0; k < response.lines(); ++k) {
    const double s2 = variance.re[response.at(k, i, j)];
    series.y.push_back(s2 > 0.0 ? 10.0 * std::log10(s2) : kNaN);
  }
  return thinned(series, is_logarithmic(response.frequency));
}

}  // namespace

std::vector<Chart> uncertainty_charts(const Response& response) {
  std::vector<Chart> charts;
  const Array* variance = response.of_pairs("variance");
  if (variance == nullptr) return charts;
  const Array* noise = response.of_pairs("noise_variance");
  const Array* nonlinear = response.of_pairs("nonlinear_variance");
  for (std::size_t i = 0; i < response.outputs; ++i)
    for (std::size_t j = 0; j < response.inputs && charts.size() < kMostPairs; ++j) {
      Chart chart;
      chart.name = fmt::format("{}_uncertainty_{}", response.record->key, charts.size() + 1);
      chart.title = response.pair_name(i, j);
      chart.description = "Magnitude of the response and standard deviations of its estimate, in decibels over frequency.";
      chart.x_title = "Frequency [Hz]";
      chart.x_logarithmic = is_logarithmic(response.frequency);
      Panel panel;
      panel.y = {Scale::decibel, 0, 1, {}, {}, magnitude_title(response, j, {i})};
      panel.height = 290.0;
      Series size = bode_curve(response, i, j).magnitude;
      size.name = "|G|";
      size.low.clear();
      size.high.clear();
      panel.series.push_back(std::move(size));
      panel.series.push_back(deviation(response, i, j, *variance, "std of G", 1));
      if (noise != nullptr) panel.series.push_back(deviation(response, i, j, *noise, "noise part", 2));
      if (nonlinear != nullptr) panel.series.push_back(deviation(response, i, j, *nonlinear, "nonlinear, one realisation", 3));
      chart.panels.push_back(std::move(panel));
      charts.push_back(std::move(chart));
    }
  return charts;
}

std::vector<Chart> level_charts(const Response& response) {
  std::vector<Chart> charts;
  struct Kind {
    const char* array;
    const char* name;
    int colour;
  };
  constexpr Kind kKinds[] = {{"output_mean", "excited lines", 0},
                             {"odd_distortion", "odd distortion", 1},
                             {"even_distortion", "even distortion", 3},
                             {"noise_level", "noise", 2},
                             {"transient_level", "transient", 5}};
  bool any = false;
  for (const auto& kind : kKinds) any |= kind.colour != 0 && response.of_outputs(kind.array) != nullptr;
  for (std::size_t i = 0; any && i < response.outputs && i < kMostPairs; ++i) {
    Chart chart;
    chart.name = fmt::format("{}_levels_{}", response.record->key, i + 1);
    chart.title = "Levels at " + response.output(i);
    chart.description = "Level of the output at excited lines, distortion at neighbouring odd and even lines, and noise.";
    chart.x_title = "Frequency [Hz]";
    chart.x_logarithmic = is_logarithmic(response.frequency);
    Panel panel;
    panel.height = 290.0;
    std::string unit;
    for (const auto& kind : kKinds) {
      const Array* array = response.of_outputs(kind.array, true);
      if (array == nullptr) continue;
      if (unit.empty()) unit = array->unit;
      Series series;
      series.name = kind.name;
      series.colour = kind.colour;
      series.x = response.frequency;
      for (std::size_t k = 0; k < response.lines(); ++k) {
        const double level = std::abs(array->at(response.at(k, i)));
        series.y.push_back(level > 0.0 ? decibel(level) : kNaN);
      }
      panel.series.push_back(thinned(series, chart.x_logarithmic));
    }
    panel.y = {
        Scale::decibel, 0, 1, {}, {}, unit.empty() || unit == "1" ? "Level [dB]" : fmt::format("Level [dB re 1 {}]", unit)};
    chart.panels.push_back(std::move(panel));
    charts.push_back(std::move(chart));
  }
  return charts;
}

}  // namespace bodeflow::tools::report
