#include "console/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "console/console.hpp"
#include "console/model_summary.hpp"
#include "console/record_values.hpp"
#include "console/trace_summary.hpp"

namespace bodeflow::tools {
namespace {

constexpr int kLines = 12;  ///< rows of a table: what fits on a screen

/// At most kLines of `count` lines, evenly spread over the logarithm of the frequency, first and last included.
std::vector<std::size_t> shown_lines(const Json& frequency) {
  const std::size_t count = frequency.size();
  if (count <= kLines) {
    std::vector<std::size_t> all(count);
    for (std::size_t k = 0; k < count; ++k) all[k] = k;
    return all;
  }
  std::set<std::size_t> lines;
  const double least = number(frequency.front()) > 0.0 ? number(frequency.front()) : number(frequency[1]);
  const double low = std::log(least), high = std::log(number(frequency.back()));
  for (int i = 0; i < kLines; ++i) {
    const double wanted = std::exp(low + (high - low) * i / (kLines - 1));
    const auto nearest = std::min_element(frequency.begin(), frequency.end(), [&](const Json& a, const Json& b) {
      return std::abs(number(a) - wanted) < std::abs(number(b) - wanted);
    });
    lines.insert(static_cast<std::size_t>(nearest - frequency.begin()));
  }
  return {lines.begin(), lines.end()};
}

std::string channel_name(const Json& record, const char* attribute, std::size_t index) {
  const auto& attributes = record["attributes"];
  if (attributes.contains(attribute) && attributes[attribute].is_array() && index < attributes[attribute].size() &&
      attributes[attribute][index].is_string())
    return attributes[attribute][index].get<std::string>();
  return std::to_string(index + 1);
}

/// "240 lines, 11 to 250 Hz; 19 periods; errors_in_variables": what is known of it.
std::string heading(const Json& record) {
  const Json& frequency = record["arrays"]["frequency"]["data"];
  const Json& attributes = record["attributes"];
  std::string text =
      fmt::format("{} lines, {:.4g} to {:.4g} Hz", frequency.size(), number(frequency.front()), number(frequency.back()));
  for (const char* name : {"realisations", "periods", "averages"}) {
    const Json count = attributes.value(name, Json());
    if (count.is_number() && (count != 1 || name == std::string("periods"))) text += fmt::format("; {} {}", count.dump(), name);
  }
  if (attributes.contains("form") && attributes["form"].is_string()) text += "; " + attributes["form"].get<std::string>();
  return text;
}

void print_response(const Json& record) {
  const Json& arrays = record["arrays"];
  const Json& response = arrays["response"];
  const bool sure = arrays.contains("variance") && arrays["variance"]["data"].size() == response["data"].size();
  const Json& frequency = arrays["frequency"]["data"];
  const std::size_t outputs = response["shape"][1], inputs = response["shape"][2];
  fmt::print("  {}\n", heading(record));
  for (std::size_t i = 0; i < outputs; ++i)
    for (std::size_t j = 0; j < inputs; ++j) {
      fmt::print("  {} / {} [{}]\n", channel_name(record, "output_names", i), channel_name(record, "input_names", j),
                 response.value("unit", std::string()));
      fmt::print("  {}\n",
                 dim(fmt::format("{:>10} {:>12} {:>10} {:>12}", "f [Hz]", "|G|", "phase [deg]", sure ? "std of |G|" : "")));
      for (const std::size_t k : shown_lines(frequency)) {
        const std::size_t at = (k * outputs + i) * inputs + j;
        const std::complex<double> g(number(response["data"][at][0]), number(response["data"][at][1]));
        // The real and imaginary parts share the variance of the complex value: |G| has half of it.
        const std::string deviation =
            sure ? fmt::format("{:>12.2e}", std::sqrt(number(arrays["variance"]["data"][at]) / 2.0)) : "";
        fmt::print("  {:>10.4g} {:>12.5g} {:>10.2f} {}\n", number(frequency[k]), std::abs(g),
                   std::arg(g) * 180.0 / std::numbers::pi, deviation);
      }
    }
}

/// Whether a record has all that the table needs, in the shapes of its type: it may come from anybody's block.
bool is_response(const Json& record) {
  const Json& arrays = record["arrays"];
  for (const char* name : {"frequency", "response"})
    if (!arrays.contains(name) || arrays[name]["data"].empty()) return false;
  const Json& response = arrays["response"];
  return record["type"] == "frequency_response" && response["shape"].size() == 3 && response["data"].front().is_array() &&
         response["shape"][0] == arrays["frequency"]["data"].size();
}

/// Root mean square of column `output` over the lines of that kind; NaN where there are none.
double rms_of(const Json& levels, const Json& kind, std::size_t wanted, std::size_t output) {
  const std::size_t outputs = levels["shape"][1];
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < kind.size(); ++k) {
    if (kind[k] != wanted) continue;
    const double level = number(levels["data"][k * outputs + output]);
    sum += level * level;
    ++count;
  }
  return std::sqrt(sum / static_cast<double>(count));
}

/// Signal, odd and even distortion beside the noise, for each output.
void print_levels(const Json& record) {
  const Json& arrays = record["arrays"];
  const Json &levels = arrays["output_level"], &noise = arrays["output_noise"], &kind = arrays["kind"]["data"];
  fmt::print("  {}\n  {}\n", heading(record),
             dim(fmt::format("{:<24} {:>12} {:>12} {:>12} {:>12}", "root mean square", "excited", "odd", "even", "noise")));
  for (std::size_t i = 0; i < levels["shape"][1].get<std::size_t>(); ++i) {
    std::string row =
        fmt::format("{:<24}", channel_name(record, "output_names", i) + " [" + levels.value("unit", std::string()) + "]");
    for (const std::size_t wanted : {0, 1, 2}) {
      const double level = rms_of(levels, kind, wanted, i);
      row += std::isnan(level) ? fmt::format(" {:>12}", "-") : fmt::format(" {:>12.3e}", level);
    }
    double at_empty = 0.0;
    std::size_t empty = 0;
    for (const std::size_t wanted : {1, 2}) {
      const double level = rms_of(noise, kind, wanted, i);
      if (std::isnan(level)) continue;
      at_empty += level * level;
      ++empty;
    }
    fmt::print("  {} {:>12.3e}\n", row, empty > 0 ? std::sqrt(at_empty / static_cast<double>(empty)) : rms_of(noise, kind, 0, i));
  }
}

bool is_levels(const Json& record) {
  const Json& arrays = record["arrays"];
  if (record["type"] != "spectral_levels" || !arrays.contains("kind") || arrays["kind"]["data"].empty()) return false;
  for (const char* name : {"output_level", "output_noise"})
    if (!arrays.contains(name) || arrays[name]["shape"].size() != 2 || arrays[name]["shape"][0] != arrays["kind"]["data"].size())
      return false;
  return arrays["output_noise"]["shape"] == arrays["output_level"]["shape"] && arrays.contains("frequency") &&
         arrays["frequency"]["data"].size() == arrays["kind"]["data"].size();
}

/// The value with six digits a number; lists as they stand in a graph.
std::string shown(const Json& value) {
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const Json& element : value) text += (text.empty() ? "" : ", ") + shown(element);
  return "[" + text + "]";
}

void print_other(const Json& record) {
  for (const auto& [name, value] : record["attributes"].items()) {
    if (name == "warnings") continue;  // the run has said them
    const std::string text = shown(value);
    fmt::print("  {:<20} {}\n", name, text.size() > 100 ? text.substr(0, 97) + "..." : text);
  }
  for (const auto& [name, array] : record["arrays"].items()) {
    const std::string unit = array.value("unit", std::string());
    const std::string size = array["data"].size() <= 8 ? shown(array["data"]) : fmt::format("{} values", array["data"].size());
    fmt::print("  {:<20} {}{}\n", name, size, unit.empty() ? "" : " " + unit);
  }
}

void print_record(const std::string& name, const Json& record) {
  fmt::print("{}: {}\n", bold(name), record["type"].get<std::string>());
  const Json& type = record["type"];
  if (is_response(record)) return print_response(record);
  if (is_levels(record)) return print_levels(record);
  if (type == "model" && print_model(record)) return;
  if (type == "parameters" && print_derived_parameters(record)) return;
  if (type == "comparison" && print_comparison(record)) return;
  if (type == "change" && print_change(record)) return;
  if (type == "monte_carlo" && print_monte_carlo(record)) return;
  if (type == "trace" && print_trace(record)) return;
  if (type == "reveal" && print_reveal(record)) return;
  if (type == "parameter_change" && print_amplitude(record)) return;
  print_other(record);
}

}  // namespace

void print_summary(const Json& result, const std::vector<std::string>& show) {
  if (!result.contains("results")) return;
  const Json& results = result["results"];
  if (show.empty())
    for (const auto& [name, record] : results.items()) print_record(name, record);
  for (const auto& name : show)
    if (results.contains(name)) print_record(name, results[name]);
}

}  // namespace bodeflow::tools
