#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/bode.hpp"
#include "report/model.hpp"
#include "report/numbers.hpp"
#include "report/pole_zero.hpp"
#include "report/polynomial_text.hpp"
#include "report/sections.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr std::size_t kMostRows = 100;

/// nullptr: the record has no list of real parameters.
const Array* parameters_of(const Record& record) {
  const Array* parameters = record.array("parameters");
  return parameters == nullptr || parameters->is_complex() || parameters->shape.size() != 1 ? nullptr : parameters;
}

constexpr double kNormal95 = 1.959963984540054;  ///< quantile 0.975 of the standard normal distribution

std::string interval(double value, double deviation) {
  if (!std::isfinite(deviation)) return "–";
  // As many digits as tell the ends apart.
  const double size = std::max(std::abs(value), kNormal95 * deviation);
  const int digits = deviation > 0.0 ? std::clamp(3 + static_cast<int>(std::ceil(std::log10(size / deviation))), 3, 12) : 6;
  return fmt::format("{} to {}", shown(value - kNormal95 * deviation, digits), shown(value + kNormal95 * deviation, digits));
}

/// Cost beside what noise alone gives, in one sentence.
void add_cost(Page& page, const Record& record) {
  const double cost = record.number("cost"), expected = record.number("expected_cost");
  if (!std::isfinite(cost)) return;
  std::string text = "Cost " + shown(cost, 5);
  const double freedom = record.number("cost_degrees_of_freedom"), given = record.number("cost_deviation");
  const double deviation = std::isfinite(given) ? given : freedom > 0.0 ? std::sqrt(freedom / 2.0) : kNaN;
  if (std::isfinite(expected)) text += ", expected " + shown(expected, 5);
  if (std::isfinite(expected) && std::isfinite(deviation)) {
    text += fmt::format(" ± {}", shown(deviation, 3));
    const double apart = (cost - expected) / deviation;
    if (apart > 3.0)
      text += fmt::format(": {} standard deviations too much. The model lacks something, or the noise is stated too small",
                          shown(apart, 3));
    else if (apart < -3.0)
      text += fmt::format(": {} standard deviations too little. The noise is stated too great", shown(-apart, 3));
    else
      text += ": the noise explains what the model leaves";
  }
  page.body().open("p").element("b", text + ".").close("p");
}

void add_conventions(Page& page, const Record& record) {
  for (const auto& convention : record.texts("conventions")) page.paragraph("Convention: " + convention + ".");
}

void add_parameters(Page& page, const Record& record) {
  const Array* parameters = parameters_of(record);
  if (parameters == nullptr) return;
  const std::size_t count = parameters->size();
  const Array* covariance = record.array("covariance", {count, count});
  const auto units = record.texts("parameter_units");
  Table table{"Parameters", {{"Parameter", false}, {"Value"}, {"std"}, {"95 % interval", false}, {"Relative std"}}, {}};
  for (std::size_t n = 0; n < std::min(count, kMostRows); ++n) {
    const double value = parameters->re[n], deviation = covariance == nullptr ? kNaN : std::sqrt(covariance->re[n * count + n]);
    const std::string name = record.text_at("parameter_names", n, fmt::format("parameter {}", n + 1));
    table.rows.push_back({with_unit(name, n < units.size() ? units[n] : parameters->unit), shown(value, 6), shown(deviation, 3),
                          interval(value, deviation), percent(value == 0.0 ? kNaN : deviation / std::abs(value))});
  }
  add_table(page.body(), table);
  if (count > kMostRows) page.note(fmt::format("{} of {} parameters are shown; all stand in result.json.", kMostRows, count));
  if (covariance == nullptr)
    page.note("The model carries no covariance that fits its parameters: how sure they are is not known.");
}

/// Natural frequency [Hz] and damping ratio of a root.
std::pair<double, double> frequency_and_damping(std::complex<double> root, bool z_plane, double sample_time) {
  if (z_plane) root = std::log(root) / sample_time;
  const double size = std::abs(root);
  return {size / (2.0 * std::numbers::pi), size > 0.0 ? -root.real() / size : kNaN};
}

void add_roots(Page& page, const Record& record, bool poles) {
  const auto roots = roots_of(record, poles);
  const bool z_plane = is_z_plane(record);
  const std::string unit = z_plane ? "" : "rad/s";
  Table table{poles ? "Poles" : "Zeros",
              {{with_unit("Real part", unit)},
               {with_unit("Imaginary part", unit)},
               {"std, real"},
               {"std, imaginary"},
               {"Frequency [Hz]"},
               {"Damping ratio"}},
              {}};
  for (std::size_t n = 0; n < std::min(roots.size(), kMostRows); ++n) {
    const Root& root = roots[n];
    const auto [frequency, damping] = frequency_and_damping(root.value, z_plane, record.number("sample_time"));
    table.rows.push_back({shown(root.value.real(), 6), shown(root.value.imag(), 6),
                          root.has_covariance ? shown(std::sqrt(root.real_variance), 3) : "–",
                          root.has_covariance ? shown(std::sqrt(root.imaginary_variance), 3) : "–", shown(frequency, 5),
                          shown(damping, 3)});
  }
  add_table(page.body(), table);
}

/// |G - model| over the radius of the confidence region, line by line.
Series residual(const Response& response, const std::vector<std::complex<double>>& fitted, std::size_t i, std::size_t j) {
  Series series;
  series.x = response.frequency;
  for (std::size_t k = 0; k < response.lines(); ++k) {
    const double ratio = std::abs(response.value(k, i, j) - fitted[k]) / response.radius(k, i, j);
    series.y.push_back(std::isfinite(ratio) && ratio > 0.0 ? ratio : kNaN);
  }
  return series;
}

void add_residuals(Page& page, const Response& response, const Model& model) {
  std::vector<Chart> charts;
  const auto fitted = model.responses(response.frequency);
  Table table{"Residuals",
              {{"Output / input", false},
               {"Lines outside the region"},
               {"expected"},
               {"Median |residual| / radius"},
               {"Largest |residual| / |G|"}},
              {}};
  for (std::size_t i = 0; i < response.outputs; ++i)
    for (std::size_t j = 0; j < response.inputs && charts.size() < kMostPairs; ++j) {
      Series series = residual(response, fitted[i * model.inputs + j], i, j);
      std::size_t known = 0, outside = 0;
      double largest = kNaN;
      for (std::size_t k = 0; k < series.y.size(); ++k) {
        if (!std::isfinite(series.y[k])) continue;
        ++known;
        outside += series.y[k] > 1.0 ? 1 : 0;
        const double relative = series.y[k] * response.radius(k, i, j) / std::abs(response.value(k, i, j));
        if (std::isfinite(relative) && !(largest >= relative)) largest = relative;
      }
      if (known == 0) continue;
      table.rows.push_back({response.pair_name(i, j), percent(static_cast<double>(outside) / static_cast<double>(known)),
                            percent(1.0 - response.confidence), shown(median(series.y), 3), percent(largest)});
      Chart chart;
      chart.name = fmt::format("{}_residual_{}", model.record->key, charts.size() + 1);
      chart.title = response.pair_name(i, j);
      chart.description = "Distance of model and data over the radius of the confidence region; 1 is the region's border.";
      chart.x_title = "Frequency [Hz]";
      chart.x_logarithmic = is_logarithmic(response.frequency);
      series = thinned(series, chart.x_logarithmic);
      series.markers = series.x.size() <= kMostMarkers;
      series.line = !series.markers;
      Panel panel;
      panel.y = {Scale::logarithmic, 0, 1, {}, {}, "|Residual| / radius"};
      panel.height = 250.0;
      panel.series.push_back(std::move(series));
      panel.levels.push_back({1.0, fmt::format("{} region", percent(response.confidence))});
      chart.panels.push_back(std::move(panel));
      charts.push_back(std::move(chart));
    }
  if (charts.empty()) return;
  page.heading("Residuals");
  page.grid(
      charts,
      "Of a right model 5 % of the lines lie outside the region; many more mean that it lacks something that the data show.");
  add_table(page.body(), table);
}

constexpr std::size_t kCurvePoints = 400;

/// Frequencies [Hz] of a curve: the fitted band, else a decade around the poles; below half the sample rate.
std::vector<double> band_of(const Record& record, const Model& model) {
  double low = 0.0, high = 0.0;
  if (const auto band = record.attributes.find("band"); band != record.attributes.end() && band->is_array() &&
                                                        band->size() == 2 && (*band)[0].is_number() && (*band)[1].is_number()) {
    low = (*band)[0].get<double>();
    high = (*band)[1].get<double>();
  } else {
    for (const Root& pole : roots_of(record, true)) {
      const double f = frequency_and_damping(pole.value, is_z_plane(record), model.sample_time).first;
      if (!(f > 0.0) || !std::isfinite(f)) continue;
      low = low > 0.0 ? std::min(low, f / 10.0) : f / 10.0;
      high = std::max(high, f * 10.0);
    }
  }
  if (model.sample_time > 0.0) high = std::min(high, 0.5 / model.sample_time);
  if (!(low > 0.0)) low = high / static_cast<double>(kCurvePoints);
  if (!(high > low) || !std::isfinite(high)) return {};
  std::vector<double> frequency;
  for (std::size_t n = 0; n < kCurvePoints; ++n) {
    const double part = static_cast<double>(n) / (kCurvePoints - 1);
    frequency.push_back(high / low < 4.0 ? low + (high - low) * part : low * std::pow(high / low, part));
  }
  return frequency;
}

/// A Bode plot of the model alone, over its band, else over the frequencies of its poles.
void add_own_response(Page& page, const Record& record, const Model& model) {
  if (model.outputs != 1 || model.inputs != 1) return;
  const auto frequency = band_of(record, model);
  if (frequency.empty()) return;
  Series magnitude, phase;
  magnitude.x = phase.x = frequency;
  std::vector<double> degrees;
  const auto responses = model.responses(frequency);
  for (const auto& g : responses[0]) {
    magnitude.y.push_back(std::abs(g) > 0.0 ? decibel(std::abs(g)) : kNaN);
    degrees.push_back(std::arg(g) * 180.0 / std::numbers::pi);
  }
  phase.y = unwrapped(degrees, std::vector<bool>(degrees.size(), true));
  const std::string above = record.text_at("output_units", 0, ""), below = record.text_at("input_units", 0, "");
  Chart chart;
  chart.name = record.key + "_bode";
  chart.title = fmt::format("{} to {}", record.text_at("input_names", 0, "input"), record.text_at("output_names", 0, "output"));
  chart.description = "Magnitude in decibels and phase in degrees of the model over frequency.";
  chart.x_title = "Frequency [Hz]";
  chart.x_logarithmic = is_logarithmic(frequency);
  Panel upper, lower;
  upper.y = {Scale::decibel,
             0,
             1,
             {},
             {},
             above.empty() || below.empty() ? "Magnitude [dB]" : fmt::format("Magnitude [dB re 1 {}/{}]", above, below)};
  upper.height = 270.0;
  upper.absolute = true;
  upper.series.push_back(std::move(magnitude));
  lower.y = {Scale::degrees, 0, 1, {}, {}, "Phase [°]"};
  lower.height = 180.0;
  lower.series.push_back(std::move(phase));
  chart.panels.push_back(std::move(upper));
  chart.panels.push_back(std::move(lower));
  page.heading("Response of the model");
  page.figure(chart, "The model alone, over the band that was fitted");
}

/// The last response of the model's size.
const Response* response_for(const Model& model, std::span<const Response> responses) {
  for (auto response = responses.rbegin(); response != responses.rend(); ++response)
    if (response->outputs == model.outputs && response->inputs == model.inputs) return &*response;
  return nullptr;
}

void add_polynomials(Page& page, const Record& record) {
  const Array* numerator = record.array("numerator");
  const Array* denominator = record.array("denominator");
  if (numerator == nullptr || denominator == nullptr || numerator->shape.size() != 1 || denominator->shape.size() != 1) return;
  const std::string variable = record.number("sample_time") > 0.0 ? "z" : "s";
  page.body().element("p", {{"class", "poly"}}, "Numerator: " + polynomial_text(numerator->re, variable));
  page.body().element("p", {{"class", "poly"}}, "Denominator: " + polynomial_text(denominator->re, variable));
}

}  // namespace

bool add_model(Page& page, const Record& record, std::span<const Response> responses) {
  const auto model = read_model(record);
  const bool roots = !roots_of(record, true).empty() || !roots_of(record, false).empty();
  if (!model && !roots && parameters_of(record) == nullptr) return false;
  add_cost(page, record);
  add_parameters(page, record);
  add_conventions(page, record);
  add_attributes(page, record, {"parameter_names", "parameter_units", "conventions", "cost", "expected_cost"});
  add_polynomials(page, record);
  if (const Response* response = model ? response_for(*model, responses) : nullptr; response != nullptr) {
    page.heading("Model and data");
    for (const auto& chart : bode_charts(*response, &*model))
      page.figure(chart, fmt::format("The model over '{}' with the data's {} region", response->record->key,
                                     percent(response->confidence)));
    add_residuals(page, *response, *model);
  } else if (model) {
    add_own_response(page, record, *model);
  }
  if (const auto wide = draw_pole_zero(record, kWide)) {
    page.heading("Poles and zeros");
    const std::string scales = is_z_plane(record) ? "" : "The two axes have scales of their own. ";
    page.figure(
        *wide, *draw_pole_zero(record, kNarrow), record.key + "_poles_zeros",
        scales + fmt::format("Zeros further out than {} times the outermost pole stand in the table only", shown(kFarZero)));
    add_roots(page, record, true);
    add_roots(page, record, false);
  }
  return true;
}

bool add_derived_parameters(Page& page, const Record& record) {
  if (parameters_of(record) == nullptr) return false;
  if (const std::string assumption = record.text("assumption"); !assumption.empty())
    page.paragraph("Assumption: " + assumption + ".");
  add_parameters(page, record);
  add_attributes(page, record, {"parameter_names", "parameter_units", "assumption"});
  return true;
}

}  // namespace bodeflow::tools::report
