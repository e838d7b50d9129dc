#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/numbers.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostRows = 100;
constexpr std::size_t kMostModels = 6;  ///< drawn over each other

/// The models of a comparison and what the record holds of each.
struct Compared {
  const Record& record;
  std::vector<std::string> names;

  std::size_t count() const { return names.size(); }
  std::size_t drawn() const { return std::min(count(), kMostModels); }

  /// A number of each model; NaN where absent.
  double of(const char* name, std::size_t m) const {
    const Array* array = record.array(name, {count()});
    return array == nullptr ? kNaN : array->re[m];
  }
  /// Values of one model, of an array models x values; empty where absent.
  std::vector<double> row(const char* name, std::size_t m) const {
    const Array* array = record.array(name);
    if (array == nullptr || array->is_complex() || array->shape.size() != 2 || array->shape[0] != count()) return {};
    const auto first = array->re.begin() + static_cast<std::ptrdiff_t>(m * array->shape[1]);
    return {first, first + static_cast<std::ptrdiff_t>(array->shape[1])};
  }
};

std::string probability_text(double p) { return p < 1e-4 ? "below 0.01 %" : percent(p); }

/// A row of the table of fits: what it is, and a text for each model.
template <class Text>
std::vector<std::string> row_of(const Compared& c, const std::string& title, Text text) {
  std::vector<std::string> row{title};
  for (std::size_t m = 0; m < c.drawn(); ++m) row.push_back(text(m));
  return row;
}

void add_fits(Page& page, const Compared& c) {
  const std::string steps = fmt::format("{:.0f}-step prediction", c.record.number("steps"));
  const std::string unit = c.record.text_at("output_units", 0, "");
  const Array* lag = c.record.array("lag");
  const std::size_t lags = lag == nullptr ? 0 : lag->size() / 2;
  Table table{"Fits", {{"", false}}, {}};
  for (std::size_t m = 0; m < c.drawn(); ++m) table.columns.push_back({c.names[m]});
  const auto number = [&](const std::string& title, const char* name, int digits) {
    table.rows.push_back(row_of(c, title, [&](std::size_t m) { return shown(c.of(name, m), digits); }));
  };
  const auto share = [&](const std::string& title, const char* name) {
    table.rows.push_back(row_of(c, title, [&](std::size_t m) { return percent(c.of(name, m)); }));
  };
  number("Fit of the simulation [%]", "fit", 5);
  number("Fit of the " + steps + " [%]", "prediction_fit", 5);
  number(with_unit("Residual of the simulation", unit), "residual_std", 4);
  number(with_unit("Residual of the " + steps, unit), "prediction_std", 4);
  number(with_unit("as its noise model says", unit), "expected_prediction_std", 4);
  number("FPE", "fpe", 4);
  number("AIC", "aic", 6);
  table.rows.push_back(row_of(c, "Noise model", [&](std::size_t m) { return c.record.text_at("noise_models", m, "–"); }));
  table.rows.push_back(row_of(c, "Probability of as much correlation in white noise",
                              [&](std::size_t m) { return probability_text(c.of("whiteness_probability", m)); }));
  table.rows.push_back(row_of(c, "Lags at which the residual depends on the input",
                              [&](std::size_t m) { return fmt::format("{:.0f} of {}", c.of("cross_outside", m), lags + 1); }));
  share("Energy of the input outside the fitted band", "input_outside_band");
  share("Energy of the output outside the fitted band", "output_outside_band");
  add_table(page.body(), table);
  page.paragraph(
      fmt::format("Fit: 100 (1 − |y − ŷ| / |y − mean y|). Estimated beside the models: {}. The noise models are fitted to {}; "
                  "FPE and AIC count "
                  "their parameters, too.",
                  c.record.text("estimated"), c.record.text("noise_models_from")));
}

Series curve(const std::string& name, int colour, const std::vector<double>& x, std::vector<double> y) {
  Series series;
  series.name = name;
  series.colour = colour;
  series.x = x;
  series.y = std::move(y);
  return series;
}

/// Measured output with the models' over it, and what they leave.
void add_signals(Page& page, const Compared& c, const char* array, const std::string& what) {
  const Array* time = c.record.array("time");
  if (time == nullptr || time->shape.size() != 1) return;
  const Array* measured = c.record.array("measured", time->shape);
  if (measured == nullptr) return;
  const std::string output = with_unit(c.record.text_at("output_names", 0, "output"), measured->unit);
  Chart chart;
  chart.title = fmt::format("Measured and {} output", what);
  chart.name = fmt::format("{}_{}", c.record.key, what);
  chart.description = fmt::format("The measured output over time, with that {} by each model; below, the difference.", what);
  chart.x_title = "Time [s]";
  Panel upper, lower;
  upper.y.title = output;
  upper.height = 270.0;
  lower.y.title = "Difference" + (measured->unit.empty() ? "" : " [" + measured->unit + "]");
  lower.height = 150.0;
  upper.series.push_back(thinned(curve("measured", 0, time->re, measured->re), false));
  upper.series.back().solid = true;
  for (std::size_t m = 0; m < c.drawn(); ++m) {
    const auto y = c.row(array, m);
    if (y.size() != time->size()) continue;
    Series series = curve(c.names[m], static_cast<int>(m) + 1, time->re, y);
    Series left = series;
    left.name.clear();
    for (std::size_t n = 0; n < y.size(); ++n) left.y[n] = measured->re[n] - y[n];
    upper.series.push_back(thinned(series, false));
    lower.series.push_back(thinned(left, false));
  }
  chart.panels.push_back(std::move(upper));
  chart.panels.push_back(std::move(lower));
  page.figure(chart);
}

/// Correlations of one model over the lags, with their band.
Chart correlation_chart(const Compared& c, std::size_t m, const char* array, const char* band, const std::vector<double>& lags,
                        const std::string& title, const std::string& axis) {
  Chart chart;
  chart.title = c.count() > 1 ? fmt::format("{}: {}", c.names[m], title) : title;
  chart.name = fmt::format("{}_{}_{}", c.record.key, array, m + 1);
  chart.description = fmt::format("{} over the lag in samples, between the bounds that chance leaves.", title);
  chart.x_title = "Lag [samples]";
  Panel panel;
  panel.y.title = axis;
  panel.height = 220.0;
  Series series = curve("", 0, lags, c.row(array, m));
  if (lags.front() == 0.0) {  // where it is 1 by definition
    series.x.erase(series.x.begin());
    series.y.erase(series.y.begin());
  }
  series.markers = lags.size() <= kMostMarkers;
  const double bound = c.of(band, m);
  Series chance = curve("", 5, {lags.front(), lags.back()}, {0.0, 0.0});
  chance.low = {-bound, -bound};
  chance.high = {bound, bound};
  panel.series.push_back(std::move(chance));
  panel.series.push_back(std::move(series));
  chart.panels.push_back(std::move(panel));
  return chart;
}

void add_correlations(Page& page, const Compared& c) {
  const Array* lag = c.record.array("lag");
  if (lag == nullptr || lag->shape.size() != 1 || lag->size() < 3) return;
  const std::vector<double> after(lag->re.begin() + static_cast<std::ptrdiff_t>(lag->size() / 2), lag->re.end());
  std::vector<Chart> charts;
  for (std::size_t m = 0; m < c.drawn(); ++m) {
    if (c.row("cross_correlation", m).size() != lag->size() || c.row("innovation_autocorrelation", m).size() != after.size())
      continue;
    charts.push_back(correlation_chart(c, m, "cross_correlation", "cross_correlation_band", lag->re,
                                       "residual of the simulation with the input", "Correlation"));
    charts.push_back(correlation_chart(c, m, "innovation_autocorrelation", "autocorrelation_band", after,
                                       "one-step prediction error with itself", "Correlation"));
  }
  if (charts.empty()) return;
  page.heading("Correlations of the residuals");
  page.grid(
      charts,
      fmt::format("Shaded: {} of the lags stay within by chance. Beyond it at positive lags the model lacks something of how "
                  "the output follows the input; at negative lags alone the output acts back on the input. Noise on the "
                  "measured input shows around lag 0.",
                  percent(c.record.number("confidence"))));
}

void add_parameters(Page& page, const Compared& c) {
  const auto names = c.record.texts("parameter_names");
  if (names.empty() || c.row("parameters", 0).size() != names.size()) return;
  const bool differs = !c.row("parameter_difference", 0).empty();
  Table table{"Parameters", {{"Parameter", false}}, {}};
  for (std::size_t m = 0; m < c.drawn(); ++m) {
    table.columns.push_back({c.names[m]});
    table.columns.push_back({"std"});
    if (differs && m > 0) table.columns.push_back({"apart [std]"});
  }
  for (std::size_t i = 0; i < std::min(names.size(), kMostRows); ++i) {
    std::vector<std::string> row{with_unit(names[i], c.record.text_at("parameter_units", i, ""))};
    for (std::size_t m = 0; m < c.drawn(); ++m) {
      row.push_back(shown(c.row("parameters", m)[i], 6));
      const auto deviations = c.row("parameter_std", m);
      row.push_back(i < deviations.size() ? shown(deviations[i], 3) : "–");
      if (differs && m > 0) row.push_back(shown(c.row("parameter_difference", m)[i], 3));
    }
    table.rows.push_back(std::move(row));
  }
  page.heading("Parameters side by side");
  add_table(page.body(), table);
  for (std::size_t m = 1; m < c.count(); ++m)
    if (const double p = c.of("parameter_probability", m); std::isfinite(p))
      page.paragraph(
          fmt::format("{} and {}: all common parameters together differ so much by chance with a probability of {}, if "
                      "their data are independent.",
                      c.names[0], c.names[m], probability_text(p)));
}

void add_poles(Page& page, const Compared& c) {
  const Array* poles = c.record.array("poles");
  if (poles == nullptr || !poles->is_complex() || poles->shape.size() != 2 || poles->shape[0] != c.count()) return;
  Table table{"Poles", {{"Pole"}}, {}};
  for (std::size_t m = 0; m < c.drawn(); ++m) {
    table.columns.push_back({c.names[m] + ", frequency [Hz]"});
    table.columns.push_back({"damping ratio"});
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(poles->shape[1], kMostRows); ++i) {
    std::vector<std::string> row{std::to_string(i + 1)};
    for (std::size_t m = 0; m < c.drawn(); ++m) {
      const auto p = poles->at(m * poles->shape[1] + i);
      row.push_back(shown(std::abs(p) / (2.0 * std::numbers::pi), 6));
      row.push_back(shown(-p.real() / std::abs(p), 4));
    }
    table.rows.push_back(std::move(row));
  }
  add_table(page.body(), table);
}

void add_responses(Page& page, const Compared& c) {
  const Array* frequency = c.record.array("frequency");
  if (frequency == nullptr || frequency->shape.size() != 1) return;
  const Array* response = c.record.array("response", {c.count(), frequency->shape[0]}, true);
  if (response == nullptr) return;
  Chart chart;
  chart.title = "Responses of the models";
  chart.name = c.record.key + "_responses";
  chart.description = "Magnitude in decibels and phase in degrees of each model over frequency.";
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = is_logarithmic(frequency->re);
  Panel upper, lower;
  upper.y = {Scale::decibel,
             0,
             1,
             {},
             {},
             response->unit.empty() || response->unit == "1" ? "Magnitude [dB]" : "Magnitude [dB re 1 " + response->unit + "]"};
  upper.height = 270.0;
  upper.absolute = true;
  lower.y = {Scale::degrees, 0, 1, {}, {}, "Phase [°]"};
  lower.height = 180.0;
  for (std::size_t m = 0; m < c.drawn(); ++m) {
    std::vector<double> size, degrees;
    for (std::size_t k = 0; k < frequency->size(); ++k) {
      const auto g = response->at(m * frequency->size() + k);
      size.push_back(std::abs(g) > 0.0 ? decibel(std::abs(g)) : kNaN);
      degrees.push_back(std::arg(g) * 180.0 / std::numbers::pi);
    }
    const std::vector<bool> trusted(degrees.size(), true);
    upper.series.push_back(curve(c.names[m], static_cast<int>(m), frequency->re, std::move(size)));
    lower.series.push_back(curve("", static_cast<int>(m), frequency->re, unwrapped(degrees, trusted)));
  }
  chart.panels.push_back(std::move(upper));
  chart.panels.push_back(std::move(lower));
  page.figure(chart);
}

}  // namespace

bool add_comparison(Page& page, const Record& record) {
  const Compared c{record, record.texts("models")};
  if (c.count() == 0) return false;
  if (c.count() > kMostModels)
    page.note(fmt::format("{} of {} models are drawn; all stand in result.json.", kMostModels, c.count()));
  if (record.array("fit", {c.count()}) != nullptr) {
    add_fits(page, c);
    add_signals(page, c, "simulated", "simulated");
    add_signals(page, c, "predicted", "predicted");
    add_correlations(page, c);
  }
  add_parameters(page, c);
  add_poles(page, c);
  add_responses(page, c);
  return true;
}

}  // namespace bodeflow::tools::report
