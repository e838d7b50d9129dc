#include "report/bode.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kOutputsInOne = 4;
constexpr std::size_t kModelPoints = 600;
constexpr double kDegrees = 180.0 / std::numbers::pi;

double magnitude_low(double magnitude, double radius) {
  if (std::isnan(radius)) return kNaN;
  return radius < magnitude ? decibel(magnitude - radius) : -HUGE_VAL;
}

void name_series(const Response& response, std::size_t i, std::size_t j, bool mixed_units, Series& series) {
  series.name = response.pair_name(i, j);
  if (mixed_units) series.name = with_unit(series.name, response.unit(i, j));
}

Panel coherence_panel(const Response& response, const Array& coherence, const std::vector<std::size_t>& outputs,
                      bool logarithmic) {
  Panel panel;
  panel.y.title = "Coherence";
  panel.height = 95.0;
  double least = 1.0;
  for (std::size_t n = 0; n < outputs.size(); ++n) {
    Series series;
    series.colour = static_cast<int>(n);
    series.x = response.frequency;
    for (std::size_t k = 0; k < response.lines(); ++k) series.y.push_back(coherence.re[response.at(k, outputs[n])]);
    for (const double y : series.y)
      if (y < least) least = y;
    panel.series.push_back(thinned(series, logarithmic));
  }
  panel.range = Extent{least >= 0.99 ? 0.99 : least >= 0.9 ? 0.9 : least >= 0.5 ? 0.5 : 0.0, 1.0};
  return panel;
}

/// Frequencies for a smooth curve: evenly spread, and the lines themselves where they are few.
std::vector<double> model_frequencies(const Response& response, bool logarithmic) {
  std::vector<double> frequency;
  const double high = response.frequency.back();
  double low = response.frequency.front();
  if (logarithmic && !(low > 0.0)) low = *std::upper_bound(response.frequency.begin(), response.frequency.end(), 0.0);
  for (std::size_t n = 0; n < kModelPoints; ++n) {
    const double part = static_cast<double>(n) / (kModelPoints - 1);
    frequency.push_back(logarithmic ? low * std::pow(high / low, part) : low + (high - low) * part);
  }
  if (response.lines() <= 4 * kModelPoints)
    for (const double f : response.frequency)
      if (f >= low) frequency.push_back(f);
  std::sort(frequency.begin(), frequency.end());
  return frequency;
}

/// A model's values at the frequencies at which it is drawn.
struct Drawn {
  const Model* model = nullptr;
  std::vector<double> frequency;
  std::vector<std::vector<std::complex<double>>> values;  ///< as Model::responses gives them
};

/// The model's curves; its phase is moved by whole turns to where the data lie.
BodeCurve model_curve(const Drawn& drawn, std::size_t i, std::size_t j, const BodeCurve& data) {
  BodeCurve curve;
  for (Series* series : {&curve.magnitude, &curve.phase}) {
    series->x = drawn.frequency;
    series->model = true;
  }
  std::vector<bool> trusted;
  std::vector<double> phase;
  for (const auto& g : drawn.values[i * drawn.model->inputs + j]) {
    curve.magnitude.y.push_back(std::abs(g) > 0.0 ? decibel(std::abs(g)) : kNaN);
    phase.push_back(std::abs(g) > 0.0 ? std::arg(g) * kDegrees : kNaN);
    trusted.push_back(true);
  }
  curve.phase.y = unwrapped(phase, trusted);
  std::vector<double> apart;
  for (std::size_t k = 0; k < data.phase.x.size(); ++k) {
    const auto next = std::lower_bound(curve.phase.x.begin(), curve.phase.x.end(), data.phase.x[k]);
    if (next != curve.phase.x.end())
      apart.push_back(data.phase.y[k] - curve.phase.y[static_cast<std::size_t>(next - curve.phase.x.begin())]);
  }
  const double middle = median(apart);
  if (std::isfinite(middle))
    for (double& y : curve.phase.y) y += 360.0 * std::round(middle / 360.0);
  return curve;
}

Chart bode_chart(const Response& response, std::size_t j, const std::vector<std::size_t>& outputs, const Drawn* model) {
  Chart chart;
  const bool logarithmic = is_logarithmic(response.frequency);
  chart.x_logarithmic = logarithmic;
  chart.x_title = "Frequency [Hz]";
  Panel magnitude, phase;
  magnitude.y = {Scale::decibel, 0, 1, {}, {}, magnitude_title(response, j, outputs)};
  magnitude.height = 270.0;
  phase.y = {Scale::degrees, 0, 1, {}, {}, "Phase [°]"};
  phase.height = 180.0;
  const bool mixed = magnitude.y.title == "Magnitude [dB]" && outputs.size() > 1;
  magnitude.absolute = !mixed || outputs.size() == 1;
  for (std::size_t n = 0; n < outputs.size(); ++n) {
    BodeCurve curve = bode_curve(response, outputs[n], j);
    for (Series* series : {&curve.magnitude, &curve.phase}) {
      series->colour = static_cast<int>(n);
      series->solid = model != nullptr;
      series->markers = series->x.size() <= kMostMarkers;
      series->line = model == nullptr || !series->markers;
    }
    name_series(response, outputs[n], j, mixed, curve.magnitude);
    magnitude.series.push_back(curve.magnitude);
    phase.series.push_back(curve.phase);
    if (model == nullptr) continue;
    BodeCurve fitted = model_curve(*model, outputs[n], j, curve);
    fitted.magnitude.colour = fitted.phase.colour = outputs.size() == 1 ? 1 : static_cast<int>(n);
    fitted.magnitude.name = outputs.size() == 1 ? "model" : "model of " + response.output(outputs[n]);
    magnitude.series.push_back(fitted.magnitude);
    phase.series.push_back(fitted.phase);
  }
  chart.panels.push_back(std::move(magnitude));
  chart.panels.push_back(std::move(phase));
  if (const Array* coherence = response.of_outputs("coherence"); coherence != nullptr && model == nullptr)
    chart.panels.push_back(coherence_panel(response, *coherence, outputs, logarithmic));
  return chart;
}

std::string band_text(const Response& response) {
  return fmt::format("{} lines from {} to {} Hz", response.lines(), shown(response.frequency.front()),
                     shown(response.frequency.back()));
}

}  // namespace

std::string magnitude_title(const Response& response, std::size_t j, const std::vector<std::size_t>& outputs) {
  const std::string unit = response.unit(outputs[0], j);
  for (const std::size_t i : outputs)
    if (response.unit(i, j) != unit) return "Magnitude [dB]";
  return unit.empty() || unit == "1" ? "Magnitude [dB]" : fmt::format("Magnitude [dB re 1 {}]", unit);
}

BodeCurve bode_curve(const Response& response, std::size_t i, std::size_t j) {
  BodeCurve curve;
  std::vector<double> phase;
  std::vector<double> half;
  std::vector<bool> trusted;
  for (std::size_t k = 0; k < response.lines(); ++k) {
    const std::complex<double> g = response.value(k, i, j);
    const double size = std::abs(g), radius = response.radius(k, i, j);
    const bool usable = std::isfinite(size) && size > 0.0;
    curve.magnitude.y.push_back(usable ? decibel(size) : kNaN);
    curve.magnitude.low.push_back(usable ? magnitude_low(size, radius) : kNaN);
    curve.magnitude.high.push_back(usable && !std::isnan(radius) ? decibel(size + radius) : kNaN);
    phase.push_back(usable ? std::arg(g) * kDegrees : kNaN);
    trusted.push_back(usable && !(radius >= size));
    half.push_back(std::isnan(radius) || !usable ? kNaN : std::asin(std::min(radius / size, 1.0)) * kDegrees);
  }
  curve.phase.y = unwrapped(phase, trusted);
  for (std::size_t k = 0; k < half.size(); ++k) {
    if (!trusted[k]) curve.phase.y[k] = kNaN;
    curve.phase.low.push_back(curve.phase.y[k] - half[k]);
    curve.phase.high.push_back(curve.phase.y[k] + half[k]);
  }
  for (Series* series : {&curve.magnitude, &curve.phase}) {
    series->x = response.frequency;
    if (std::all_of(series->low.begin(), series->low.end(), [](double x) { return std::isnan(x); })) {
      series->low.clear();
      series->high.clear();
    }
    *series = thinned(*series, is_logarithmic(response.frequency));
  }
  return curve;
}

std::vector<Chart> bode_charts(const Response& response, const Model* model) {
  std::vector<Chart> charts;
  Drawn drawn{model, {}, {}};
  if (model != nullptr) {
    drawn.frequency = model_frequencies(response, is_logarithmic(response.frequency));
    drawn.values = model->responses(drawn.frequency);
  }
  for (std::size_t j = 0; j < response.inputs; ++j)
    for (std::size_t first = 0; first < response.outputs && j * response.outputs + first < kMostPairs; first += kOutputsInOne) {
      std::vector<std::size_t> outputs;
      for (std::size_t i = first; i < std::min(first + kOutputsInOne, response.outputs); ++i) outputs.push_back(i);
      Chart chart = bode_chart(response, j, outputs, model != nullptr ? &drawn : nullptr);
      std::string names;
      for (const std::size_t i : outputs) names += (names.empty() ? "" : ", ") + response.output(i);
      chart.title = fmt::format("{} to {}{}", response.input(j), names, model != nullptr ? ": model and data" : "");
      chart.description = fmt::format(
          "Magnitude in decibels and phase in degrees over frequency: {}; the shaded band is the {} "
          "confidence region.",
          band_text(response), percent(response.confidence));
      chart.name = fmt::format("{}_{}_{}", model != nullptr ? model->record->key : response.record->key,
                               model != nullptr ? "fit" : "bode", charts.size() + 1);
      charts.push_back(std::move(chart));
    }
  return charts;
}

}  // namespace bodeflow::tools::report
