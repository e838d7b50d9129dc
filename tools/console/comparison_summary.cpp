#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "console/columns.hpp"
#include "console/console.hpp"
#include "console/model_summary.hpp"
#include "console/record_values.hpp"

namespace bodeflow::tools {
namespace {

constexpr std::size_t kMostRows = 30;
constexpr std::size_t kMostModels = 4;  ///< side by side
constexpr int kName = 22;

void print_fits(const Json& record, const Json& models) {
  const Values fit = values(record, "fit"), ahead = values(record, "prediction_fit"), residual = values(record, "residual_std"),
               prediction = values(record, "prediction_std"), fpe = values(record, "fpe"),
               outside = values(record, "cross_outside"), white = values(record, "whiteness_probability");
  const std::string steps = attribute(record, "steps").dump();
  fmt::print("  {} samples at {}; estimated: {}\n", attribute(record, "samples").dump(),
             si(number(attribute(record, "sample_rate")), "Hz"), text(attribute(record, "estimated")));
  fmt::print("  {}\n", dim(fmt::format("{:<{}} {:>10} {:>12} {:>12} {:>12} {:>10}", "model", kName, "fit [%]",
                                       steps + "-step [%]", "residual", steps + "-step", "FPE")));
  for (std::size_t i = 0; i < models.size(); ++i)
    fmt::print("  {:<{}} {} {} {} {} {}\n", shortened(text(models[i]), kName), kName, cell(fit.at(i), 10, 5),
               cell(ahead.at(i), 12, 5), cell(residual.at(i), 12, 4), cell(prediction.at(i), 12, 4), cell(fpe.at(i), 10, 3));
  const std::size_t lags = values(record, "lag").data.size() / 2;
  for (std::size_t i = 0; i < models.size(); ++i)
    fmt::print("  {}: the residual depends on the input at {:.0f} of {} lags; noise model: {}{}\n", text(models[i]),
               outside.at(i), lags + 1, text_at(attribute(record, "noise_models"), i),
               white.at(i) < 0.01 ? ", which leaves a residual that is not white" : "");
}

void print_parameters(const Json& record, const Json& models) {
  const Values parameters = values(record, "parameters"), deviations = values(record, "parameter_std"),
               difference = values(record, "parameter_difference"), probability = values(record, "parameter_probability");
  if (parameters.shape.size() != 2) return;
  const std::size_t shown = std::min(models.size(), kMostModels), count = parameters.shape[1];
  std::string head = fmt::format("{:<{}}", "parameter", kName);
  for (std::size_t m = 0; m < shown; ++m) head += fmt::format(" {:>13} {:>9}", shortened(text(models[m]), 13), "std");
  const bool differs = shown == 2 && !difference.empty();
  if (differs) head += fmt::format(" {:>11}", "apart [std]");
  fmt::print("  {}\n", dim(head));
  for (std::size_t i = 0; i < std::min(count, kMostRows); ++i) {
    const std::string name =
        named(text_at(attribute(record, "parameter_names"), i), text_at(attribute(record, "parameter_units"), i));
    std::string row = fmt::format("{:<{}}", shortened(name, kName), kName);
    for (std::size_t m = 0; m < shown; ++m) row += " " + cell(parameters.at(m, i), 13, 6) + " " + cell(deviations.at(m, i), 9, 2);
    if (differs) row += " " + cell(difference.at(1, i), 11, 2);
    fmt::print("  {}\n", row);
  }
  if (count > kMostRows) fmt::print("  {}\n", dim(fmt::format("and {} more in result.json", count - kMostRows)));
  for (std::size_t m = 1; m < models.size(); ++m)
    if (std::isfinite(probability.at(m)))
      fmt::print("  '{}' and '{}': parameters that differ so much by chance alone have a probability of {:.2g}\n",
                 text(models[0]), text(models[m]), probability.at(m));
}

void print_poles(const Json& record, const Json& models) {
  const auto poles = complex_values(record, "poles");
  if (models.empty() || poles.size() < models.size()) return;
  const std::size_t each = poles.size() / models.size(), shown = std::min(models.size(), kMostModels);
  std::string head = fmt::format("{:<{}}", "pole", kName);
  for (std::size_t m = 0; m < shown; ++m) head += fmt::format(" {:>13} {:>9}", "f [Hz]", "damping");
  fmt::print("  {}\n", dim(head));
  for (std::size_t i = 0; i < std::min(each, kMostRows); ++i) {
    std::string row = fmt::format("{:<{}}", i + 1, kName);
    for (std::size_t m = 0; m < shown; ++m) {
      const auto p = poles[m * each + i];
      const double size = std::abs(p);
      row += " " + cell(size / (2.0 * std::numbers::pi), 13, 6) + " " + cell(size > 0.0 ? -p.real() / size : std::nan(""), 9, 3);
    }
    fmt::print("  {}\n", row);
  }
}

}  // namespace

bool print_comparison(const Json& record) {
  const Json& models = attribute(record, "models");
  if (!models.is_array() || models.empty()) return false;
  if (!values(record, "fit").empty()) print_fits(record, models);
  print_parameters(record, models);
  print_poles(record, models);
  if (models.size() > kMostModels) fmt::print("  {}\n", dim("more models stand in result.json and the report"));
  return true;
}

}  // namespace bodeflow::tools
