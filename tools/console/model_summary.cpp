#include "console/model_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "console/columns.hpp"
#include "console/console.hpp"
#include "console/record_values.hpp"

namespace bodeflow::tools {
namespace {

constexpr std::size_t kMostRows = 30;
constexpr int kWidth = 26;  ///< of a name with its unit

void print_more(std::size_t count) {
  if (count > kMostRows) fmt::print("  {}\n", dim(fmt::format("and {} more in result.json", count - kMostRows)));
}

void print_model_heading(const Json& record) {
  const double sample_time = number(attribute(record, "sample_time")), order = number(attribute(record, "order"));
  std::string heading = text(attribute(record, "method"));
  if (std::isfinite(order)) heading += fmt::format("; order {:.0f}", order);
  heading += sample_time > 0.0 ? fmt::format("; discrete in time, {}", si(sample_time, "s")) : "; continuous in time";
  if (const double delay = number(attribute(record, "delay")); delay != 0.0 && std::isfinite(delay))
    heading += "; delay " + si(delay, "s");
  const Json& band = attribute(record, "band");
  if (band.is_array() && band.size() == 2)
    heading += fmt::format("; fitted from {:.4g} to {:.4g} Hz", number(band[0]), number(band[1]));
  fmt::print("  {}\n", heading);
}

/// What a fit to a response leaves, where the method tells it.
void print_fit(const Json& record) {
  const double relative = number(attribute(record, "relative_error")), rms = number(attribute(record, "rms_error")),
               largest = number(attribute(record, "max_error"));
  if (!std::isfinite(relative)) return;
  std::string line = fmt::format("leaves {:.3g} % of the weighted response", 100.0 * relative);
  if (std::isfinite(rms) && std::isfinite(largest)) line += fmt::format("; rms error {:.3g}, largest {:.3g}", rms, largest);
  const double states = number(attribute(record, "states")), before = number(attribute(record, "states_before"));
  if (std::isfinite(states)) line += fmt::format("; {:.0f} states", states);
  if (std::isfinite(before)) line += fmt::format(" of {:.0f}", before);
  const double gap = number(attribute(record, "hankel_gap"));
  if (std::isfinite(gap)) line += fmt::format(", the next Hankel singular value is {:.3g} times smaller", gap);
  fmt::print("  {}\n", line);
}

void print_parameters(const Json& record, const Values& parameters) {
  const Values covariance = values(record, "covariance");
  const std::size_t count = parameters.data.size();
  const bool certain = covariance.shape == std::vector<std::size_t>{count, count};
  fmt::print("  {}\n", dim(fmt::format("{:<{}} {:>14} {:>11} {:>9}", "parameter", kWidth, "value", "std", "relative")));
  for (std::size_t i = 0; i < std::min(count, kMostRows); ++i) {
    const double value = parameters.at(i), deviation = certain ? std::sqrt(covariance.at(i, i)) : std::nan("");
    const double relative = value == 0.0 ? std::nan("") : 100.0 * deviation / std::abs(value);
    const std::string name = named(text_at(attribute(record, "parameter_names"), i, fmt::format("parameter {}", i + 1)),
                                   text_at(attribute(record, "parameter_units"), i, parameters.unit));
    fmt::print("  {:<{}} {} {} {}\n", shortened(name, kWidth), kWidth, cell(value, 14, 7), cell(deviation, 11, 3),
               std::isfinite(relative) ? fmt::format("{:>7.2g} %", relative) : fmt::format("{:>9}", "-"));
  }
  print_more(count);
}

/// A row each pair or real pole: frequency [Hz], its deviation, damping ratio.
void print_poles(const Json& record) {
  const auto poles = complex_values(record, "poles");
  const Values covariance = values(record, "pole_covariance");
  const bool certain = covariance.shape == std::vector<std::size_t>{poles.size(), 2, 2};
  bool first = true;
  std::size_t count = 0;
  for (std::size_t i = 0; i < poles.size(); ++i) {
    if (poles[i].imag() < 0.0) continue;
    if (++count > kMostRows) continue;
    if (first) fmt::print("  {}\n", dim(fmt::format("{:<{}} {:>14} {:>11} {:>9}", "pole", kWidth, "f [Hz]", "std", "damping")));
    first = false;
    const double size = std::abs(poles[i]), hz = size / (2.0 * std::numbers::pi);
    double deviation = std::nan("");
    if (certain && size > 0.0) {
      // d|p| = (re d re + im d im) / |p|
      const double re = poles[i].real() / size, im = poles[i].imag() / size;
      const double variance =
          re * re * covariance.at(4 * i) + 2.0 * re * im * covariance.at(4 * i + 1) + im * im * covariance.at(4 * i + 3);
      deviation = std::sqrt(variance) / (2.0 * std::numbers::pi);
    }
    const std::string kind = poles[i].imag() > 0.0 ? "pair" : poles[i].real() > 0.0 ? "real, unstable" : "real";
    fmt::print("  {:<{}} {} {} {}\n", kind, kWidth, cell(hz, 14, 6), cell(deviation, 11, 3),
               cell(size > 0.0 ? -poles[i].real() / size : std::nan(""), 9, 3));
  }
  print_more(count);
}

void print_cost(const Json& record) {
  const double cost = number(attribute(record, "cost")), expected = number(attribute(record, "expected_cost"));
  if (!std::isfinite(cost)) return;
  std::string line = fmt::format("cost {:.5g}", cost);
  if (std::isfinite(expected)) {
    line += fmt::format(", expected {:.5g}", expected);
    const double freedom = number(attribute(record, "cost_degrees_of_freedom")),
                 given = number(attribute(record, "cost_deviation"));
    const double deviation = std::isfinite(given) ? given : freedom > 0.0 ? std::sqrt(freedom / 2.0) : std::nan("");
    if (std::isfinite(deviation)) line += fmt::format(" with a standard deviation of {:.3g}", deviation);
  }
  fmt::print("  {}\n", line);
}

void print_noise(const Json& record) {
  const double input = number(attribute(record, "input_noise_variance")),
               output = number(attribute(record, "output_noise_variance"));
  if (std::isfinite(input) || std::isfinite(output))
    fmt::print("  noise, standard deviation:{}{}\n",
               std::isfinite(input) ? fmt::format(" input {:.4g}{}", std::sqrt(input),
                                                  text_at(attribute(record, "input_units"), 0).empty()
                                                      ? ""
                                                      : " " + text_at(attribute(record, "input_units"), 0))
                                    : "",
               std::isfinite(output) ? fmt::format("{} output {:.4g}{}", std::isfinite(input) ? "," : "", std::sqrt(output),
                                                   text_at(attribute(record, "output_units"), 0).empty()
                                                       ? ""
                                                       : " " + text_at(attribute(record, "output_units"), 0))
                                     : "");
}

}  // namespace

bool print_model(const Json& record) {
  const Values parameters = values(record, "parameters");
  const auto poles = complex_values(record, "poles");
  if (parameters.empty() && poles.empty()) return false;
  print_model_heading(record);
  print_fit(record);
  if (!parameters.empty()) print_parameters(record, parameters);
  print_poles(record);
  print_cost(record);
  print_noise(record);
  return true;
}

bool print_derived_parameters(const Json& record) {
  const Values parameters = values(record, "parameters");
  if (parameters.empty()) return false;
  if (const std::string assumption = text(attribute(record, "assumption")); !assumption.empty())
    fmt::print("  assumption: {}\n", assumption);
  print_parameters(record, parameters);
  return true;
}

bool print_monte_carlo(const Json& record) {
  const Values mean = values(record, "mean"), deviation = values(record, "std");
  if (mean.empty() || deviation.data.size() != mean.data.size()) return false;
  const Values truth = values(record, "truth"), published = values(record, "published_mean"),
               published_std = values(record, "published_std");
  std::string head = fmt::format("{:<{}} {:>12} {:>11}", "", kWidth, "mean", "std");
  if (!truth.empty()) head += fmt::format(" {:>12}", "truth");
  if (!published.empty()) head += fmt::format(" {:>12}", "published");
  if (!published_std.empty()) head += fmt::format(" {:>11}", "std");
  fmt::print("  {} runs\n  {}\n", attribute(record, "runs").dump(), dim(head));
  for (std::size_t i = 0; i < std::min(mean.data.size(), kMostRows); ++i) {
    const std::string name = named(text_at(attribute(record, "quantity_names"), i, fmt::format("quantity {}", i + 1)),
                                   text_at(attribute(record, "quantity_units"), i));
    std::string row =
        fmt::format("{:<{}} {} {}", shortened(name, kWidth), kWidth, cell(mean.at(i), 12, 6), cell(deviation.at(i), 11, 3));
    if (!truth.empty()) row += " " + cell(truth.at(i), 12, 6);
    if (!published.empty()) row += " " + cell(published.at(i), 12, 6);
    if (!published_std.empty()) row += " " + cell(published_std.at(i), 11, 3);
    fmt::print("  {}\n", row);
  }
  print_more(mean.data.size());
  return true;
}

}  // namespace bodeflow::tools
