#include "console/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>

#include "console/console.hpp"

namespace bodeflow::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kLines = 12;  ///< rows of a table: what fits on a screen

double number(const Json& value) { return value.is_number() ? value.get<double>() : std::nan(""); }

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

void print_response(const Json& record) {
  const Json& response = record["arrays"]["response"];
  const Json& variance = record["arrays"]["variance"];
  const Json& frequency = record["arrays"]["frequency"]["data"];
  const std::size_t outputs = response["shape"][1], inputs = response["shape"][2];
  const auto& attributes = record["attributes"];
  fmt::print("  {} lines, {:.4g} to {:.4g} Hz; {} periods; {}\n", frequency.size(), number(frequency.front()),
             number(frequency.back()), attributes.value("periods", Json("?")).dump(), attributes.value("form", std::string()));
  for (std::size_t i = 0; i < outputs; ++i)
    for (std::size_t j = 0; j < inputs; ++j) {
      fmt::print("  {} / {} [{}]\n", channel_name(record, "output_names", i), channel_name(record, "input_names", j),
                 response.value("unit", std::string()));
      fmt::print("  {}\n", dim(fmt::format("{:>10} {:>12} {:>10} {:>12}", "f [Hz]", "|G|", "phase [deg]", "std of |G|")));
      for (const std::size_t k : shown_lines(frequency)) {
        const std::size_t at = (k * outputs + i) * inputs + j;
        const std::complex<double> g(number(response["data"][at][0]), number(response["data"][at][1]));
        // The real and imaginary parts share the variance of the complex value: |G| has half of it.
        const double deviation = std::sqrt(number(variance["data"][at]) / 2.0);
        fmt::print("  {:>10.4g} {:>12.5g} {:>10.2f} {:>12.2e}\n", number(frequency[k]), std::abs(g),
                   std::arg(g) * 180.0 / std::numbers::pi, deviation);
      }
    }
}

/// Whether a record has all that the table needs, in the shapes of its type: it may come from anybody's block.
bool is_response(const Json& record) {
  const Json& arrays = record["arrays"];
  for (const char* name : {"frequency", "response", "variance"})
    if (!arrays.contains(name) || arrays[name]["data"].empty()) return false;
  const Json& response = arrays["response"];
  return record["type"] == "frequency_response" && response["shape"].size() == 3 && response["data"].front().is_array() &&
         response["data"].size() == arrays["variance"]["data"].size() &&
         response["shape"][0] == arrays["frequency"]["data"].size();
}

void print_other(const Json& record) {
  for (const auto& [name, value] : record["attributes"].items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    fmt::print("  {:<20} {}\n", name, text.size() > 100 ? text.substr(0, 97) + "..." : text);
  }
  for (const auto& [name, array] : record["arrays"].items()) {
    const std::string unit = array.value("unit", std::string());
    const std::string size = array["data"].size() <= 8 ? array["data"].dump() : fmt::format("{} values", array["data"].size());
    fmt::print("  {:<20} {}{}\n", name, size, unit.empty() ? "" : " " + unit);
  }
}

}  // namespace

void print_summary(const Json& result) {
  if (!result.contains("results")) return;
  for (const auto& [name, record] : result["results"].items()) {
    fmt::print("{}: {}\n", bold(name), record["type"].get<std::string>());
    const bool response = is_response(record);
    if (response)
      print_response(record);
    else
      print_other(record);
  }
}

}  // namespace bodeflow::tools
