#include <fmt/format.h>

#include <cmath>

#include "report/bode.hpp"
#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

std::string level_title(const std::string& unit) {
  return unit.empty() || unit == "1" ? "Level [dB]" : fmt::format("Level [dB re 1 {}]", unit);
}

/// Which lines: excited, odd or even.
struct Kind {
  const char* name;
  int colour;
  double code;
};

constexpr Kind kKinds[] = {{"excited", 0, 0.0}, {"odd, not excited", 1, 1.0}, {"even, not excited", 3, 2.0}};

/// The levels of column `c` (of `columns`) with its noise, by kind of line.
Chart levels_chart(const Record& record, const Array& level, const Array* noise, std::size_t c, std::size_t columns) {
  const Array& frequency = *record.array("frequency");
  const Array* kind = record.array("kind", frequency.shape);
  Chart chart;
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = is_logarithmic(frequency.re);
  chart.description = "Levels in decibels over frequency at excited lines, at unexcited odd and even lines, and of the noise.";
  Panel panel;
  panel.y = {Scale::decibel, 0, 1, {}, {}, level_title(level.unit)};
  panel.height = 320.0;
  const auto decibels = [](double x) { return x > 0.0 ? decibel(x) : kNaN; };
  if (noise != nullptr) {
    Series series;
    series.name = "noise";
    series.colour = 2;
    series.solid = true;
    series.x = frequency.re;
    for (std::size_t k = 0; k < frequency.size(); ++k) series.y.push_back(decibels(noise->re[k * columns + c]));
    panel.series.push_back(thinned(series, chart.x_logarithmic));
  }
  for (const auto& one : kKinds) {
    Series series;
    series.name = one.name;
    series.colour = one.colour;
    series.line = false;
    series.markers = true;
    for (std::size_t k = 0; k < frequency.size(); ++k) {
      if ((kind == nullptr ? 0.0 : kind->re[k]) != one.code) continue;
      series.x.push_back(frequency.re[k]);
      series.y.push_back(decibels(std::abs(level.at(k * columns + c))));
    }
    if (!series.x.empty()) panel.series.push_back(thinned(series, chart.x_logarithmic));
  }
  chart.panels.push_back(std::move(panel));
  return chart;
}

/// Median level of a kind of lines over the median noise there, dB; "–" without noise or lines.
std::string above_noise(const Record& record, const Array& level, const Array* noise, std::size_t c, std::size_t columns,
                        double code) {
  const Array& frequency = *record.array("frequency");
  const Array* kind = record.array("kind", frequency.shape);
  if (noise == nullptr || kind == nullptr) return "–";
  std::vector<double> levels, noises;
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    if (kind->re[k] != code) continue;
    levels.push_back(std::abs(level.at(k * columns + c)));
    noises.push_back(noise->re[k * columns + c]);
  }
  const double ratio = median(levels) / median(noises);
  return std::isfinite(ratio) ? shown(ratio, 3) : "–";
}

}  // namespace

bool add_spectral_levels(Page& page, const Record& record) {
  const Array* frequency = record.array("frequency");
  const Array* level = record.array("output_level");
  if (frequency == nullptr || level == nullptr || frequency->is_complex() || frequency->size() == 0) return false;
  if (level->shape.size() > 2 || level->shape.empty() || level->shape[0] != frequency->size()) return false;
  const std::size_t outputs = level->shape.size() == 1 ? 1 : level->shape[1];
  const Array* noise = record.array("output_noise", level->shape);
  add_attributes(page, record, {"output_names", "input_name"});

  Table table{"Median level over median noise (factors)", {{"Signal", false}, {"Excited"}, {"Odd"}, {"Even"}}, {}};
  const auto add = [&](const std::string& name, const Array& values, const Array* its_noise, std::size_t c, std::size_t columns,
                       const char* caption) {
    Chart chart = levels_chart(record, values, its_noise, c, columns);
    chart.title = "Levels at " + name;
    chart.name = fmt::format("{}_levels_{}", record.key, page.plots().size() + 1);
    page.figure(chart, caption);
    table.rows.push_back({name, above_noise(record, values, its_noise, c, columns, 0.0),
                          above_noise(record, values, its_noise, c, columns, 1.0),
                          above_noise(record, values, its_noise, c, columns, 2.0)});
  };
  for (std::size_t i = 0; i < outputs && i < kMostPairs; ++i)
    add(record.text_at("output_names", i, fmt::format("output {}", i + 1)), *level, noise, i, outputs,
        "Lines that are not excited show what the plant's nonlinearity puts there, over the noise");
  if (const Array* input = record.array("input_level", frequency->shape, true))
    add(record.text_at("input_name", 0, "input"), *input, record.array("input_noise", frequency->shape), 0, 1,
        "What stands here at lines that are not excited came with the excitation, not from the plant's output");
  add_table(page.body(), table);
  return true;
}

bool add_spectral_matrix(Page& page, const Record& record) {
  const Array* frequency = record.array("frequency");
  const Array* matrix = record.array("matrix");
  if (frequency == nullptr || matrix == nullptr || frequency->is_complex() || frequency->size() == 0) return false;
  if (matrix->shape.size() != 3 || matrix->shape[0] != frequency->size() || matrix->shape[1] != matrix->shape[2]) return false;
  const std::size_t signals = matrix->shape[1];
  const Array* noise = record.array("noise_covariance", matrix->shape, true);
  add_attributes(page, record, {"signal_names", "signal_units"});
  std::vector<Chart> charts;
  for (std::size_t s = 0; s < signals && s < kMostPairs; ++s) {
    Chart chart;
    chart.title = record.text_at("signal_names", s, fmt::format("signal {}", s + 1));
    chart.name = fmt::format("{}_spectrum_{}", record.key, s + 1);
    chart.description = "Auto-spectrum in decibels over frequency: the root of the mean of |Z|² over the windows.";
    chart.x_title = "Frequency [Hz]";
    chart.x_logarithmic = is_logarithmic(frequency->re);
    Panel panel;
    panel.y = {Scale::decibel, 0, 1, {}, {}, level_title(record.text_at("signal_units", s, ""))};
    panel.height = 290.0;
    const auto add = [&](const Array& array, const char* name, int colour) {
      Series series;
      series.name = name;
      series.colour = colour;
      series.x = frequency->re;
      for (std::size_t k = 0; k < frequency->size(); ++k) {
        const double power = array.re[(k * signals + s) * signals + s];
        series.y.push_back(power > 0.0 ? 10.0 * std::log10(power) : kNaN);
      }
      panel.series.push_back(thinned(series, chart.x_logarithmic));
    };
    add(*matrix, "signal", 0);
    if (noise != nullptr) add(*noise, "noise", 2);
    chart.panels.push_back(std::move(panel));
    charts.push_back(std::move(chart));
  }
  page.grid(charts, "Root of the auto-spectra; the noise is that of one window.");
  return true;
}

}  // namespace bodeflow::tools::report
