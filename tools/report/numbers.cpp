#include "report/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bodeflow::tools::report {

std::string power_of_ten(int exponent) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) text += kDigits[c - '0'];
  return text;
}

std::string shown(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
  const auto e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  if (exponent >= -3 && exponent <= 5) {
    std::string text = fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
    if (text.find('.') != std::string::npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.back() == '.') text.pop_back();
    }
    return text.front() == '-' ? "−" + text.substr(1) : text;
  }
  std::string mantissa = scientific.substr(0, e);
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  if (mantissa.front() == '-') mantissa = "−" + mantissa.substr(1);
  return mantissa + "×" + power_of_ten(exponent);
}

std::string shown(double value, const std::string& unit, int digits) {
  const std::string text = shown(value, digits);
  return unit.empty() || unit == "1" ? text : text + " " + unit;
}

std::string percent(double fraction) { return std::isfinite(fraction) ? shown(100.0 * fraction, 3) + " %" : "–"; }

std::string counted(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, ",");
  return text;
}

std::string with_unit(const std::string& title, const std::string& unit) {
  return unit.empty() || unit == "1" ? title : title + " [" + unit + "]";
}

std::string coordinate(double value) {
  if (!std::isfinite(value)) return "0";
  const double tenths = std::round(std::clamp(value, -1e6, 1e6) * 10.0);
  const auto whole = static_cast<long>(tenths);
  const long rest = std::labs(whole % 10);
  std::string text = whole < 0 ? "-" : "";
  text += std::to_string(std::labs(whole / 10));
  if (rest != 0) text += "." + std::to_string(rest);
  return text;
}

double decibel(double magnitude) { return 20.0 * std::log10(magnitude); }

double median(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double x) { return !std::isfinite(x); }), values.end());
  if (values.empty()) return kNaN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

std::vector<double> unwrapped(std::vector<double> degrees, const std::vector<bool>& trusted) {
  double last = kNaN;
  for (std::size_t k = 0; k < degrees.size(); ++k) {
    if (!std::isfinite(degrees[k])) continue;
    if (std::isfinite(last)) degrees[k] += 360.0 * std::round((last - degrees[k]) / 360.0);
    if (trusted[k]) last = degrees[k];
  }
  return degrees;
}

}  // namespace bodeflow::tools::report
