#include "report/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/markup.hpp"
#include "report/numbers.hpp"

namespace bodeflow::tools::report {
namespace {

constexpr double kSlack = 1e-9;  ///< of a step: a tick at the very end of the axis counts
constexpr double kLargest = 1e150;

/// 1, 2 or 5 times a power of ten, not below `least`.
double round_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= least * (1.0 - kSlack)) return factor * decade;
  return 10.0 * decade;
}

double step_of(Scale scale, double span, int wanted) {
  const double least = span / wanted;
  if (scale == Scale::decibel && least > 5.0)
    for (const double step : {10.0, 20.0, 40.0, 60.0, 80.0, 100.0})
      if (step >= least) return step;
  if (scale == Scale::degrees && least > 2.0)
    for (const double step : {5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0, 720.0, 1800.0, 3600.0, 7200.0, 18000.0, 36000.0})
      if (step >= least) return step;
  return round_step(least);
}

/// Digits after the point that tell ticks `step` apart from each other.
std::string linear_label(double value, double step, double largest) {
  if (std::abs(value) < 0.5 * kSlack * step + 1e-300) value = 0.0;
  const int exponent = static_cast<int>(std::floor(std::log10(std::max(largest, 1e-300)) + kSlack));
  if (exponent > 5 || exponent < -4) {
    const double scaled = value / std::pow(10.0, exponent);
    const double scaled_step = step / std::pow(10.0, exponent);
    const int digits = std::clamp(static_cast<int>(-std::floor(std::log10(scaled_step) + kSlack)), 0, 6);
    if (value == 0.0) return "0";
    std::string text = fmt::format("{:.{}f}", scaled, digits);
    if (text.front() == '-') text = "−" + text.substr(1);
    return text + "×" + power_of_ten(exponent);
  }
  const int digits = std::clamp(static_cast<int>(-std::floor(std::log10(step) + kSlack)), 0, 9);
  std::string text = fmt::format("{:.{}f}", value, digits);
  return text.front() == '-' ? "−" + text.substr(1) : text;
}

/// Makes room where all values are the same, or nearly.
void widen(Axis& axis) {
  const double size = std::max(std::abs(axis.high), std::abs(axis.low));
  double least = std::max(1e-9 * size, 1e-300);  // what double precision can tell apart
  if (axis.scale == Scale::decibel) least = std::max(least, 1.0);
  if (axis.scale == Scale::degrees) least = std::max(least, 2.0);
  if (axis.scale == Scale::linear) least = std::max(least, 1e-6 * size);
  if (size == 0.0) least = 1.0;
  if (axis.high - axis.low >= least) return;
  if (axis.scale == Scale::linear && size > 0.0) least = std::max(0.1 * size, least);
  const double middle = 0.5 * axis.low + 0.5 * axis.high;
  axis.low = middle - 0.5 * least;
  axis.high = middle + 0.5 * least;
}

void make_linear(Axis& axis, int wanted) {
  widen(axis);
  const double span = axis.high - axis.low;
  const double step = step_of(axis.scale, span, wanted);
  if (axis.scale != Scale::exact) {
    axis.low = std::floor(axis.low / step + kSlack) * step;
    axis.high = std::ceil(axis.high / step - kSlack) * step;
  }
  const double first = std::ceil(axis.low / step - kSlack);
  const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
  for (int i = 0; i < 200; ++i) {
    const double value = (first + i) * step;
    if (value > axis.high + kSlack * step) break;
    axis.ticks.push_back({value, linear_label(value, step, largest)});
  }
}

std::string log_label(double value) {
  const double exponent = std::log10(value);
  const int whole = static_cast<int>(std::lround(exponent));
  if (whole >= -3 && whole <= 4) return shown(value, 3);
  if (std::abs(exponent - whole) < 1e-6) return power_of_ten(whole);
  return shown(value, 1);
}

void add_log_ticks(Axis& axis, int wanted) {
  const double low = std::log10(axis.low), high = std::log10(axis.high);
  const double decades = high - low;
  const int every = std::max(1, static_cast<int>(std::ceil(decades / wanted)));
  std::vector<double> factors{1.0};
  if (decades * 3.0 <= wanted + 1) factors = {1.0, 2.0, 5.0};
  if (decades * 9.0 <= wanted + 1) factors = {1.0, 2.0, 3.0, 5.0, 7.0};
  for (int exponent = static_cast<int>(std::floor(low)); exponent <= static_cast<int>(std::ceil(high)); ++exponent) {
    for (int factor = 1; factor <= 9; ++factor) {
      const double value = factor * std::pow(10.0, exponent);
      if (value < axis.low * (1.0 - kSlack) || value > axis.high * (1.0 + kSlack)) continue;
      const bool labelled = std::find(factors.begin(), factors.end(), factor) != factors.end() && exponent % every == 0;
      if (labelled)
        axis.ticks.push_back({value, log_label(value)});
      else if (decades <= 12.0)
        axis.minor.push_back(value);
    }
  }
}

void make_logarithmic(Axis& axis, int wanted) {
  if (axis.high / axis.low < 1.02) {
    axis.low /= 1.1;
    axis.high *= 1.1;
  }
  add_log_ticks(axis, wanted);
  if (axis.ticks.size() >= 2) return;
  axis.ticks.clear();
  Axis plain;  // within less than a decade: round numbers
  plain.scale = Scale::exact;
  plain.low = axis.low;
  plain.high = axis.high;
  make_linear(plain, wanted);
  axis.ticks = plain.ticks;
}

}  // namespace

double Axis::place(double value) const {
  if (scale != Scale::logarithmic) return (value - low) / (high - low);
  return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
}

std::size_t Axis::label_length() const {
  std::size_t longest = 0;
  for (const auto& tick : ticks) longest = std::max(longest, length_of(tick.label));
  return longest;
}

Axis make_axis(Scale scale, double low, double high, int wanted, std::string title) {
  Axis axis;
  axis.scale = scale;
  // Room for differences and ratios within double precision
  axis.low = std::clamp(low, -kLargest, kLargest);
  axis.high = std::clamp(high, -kLargest, kLargest);
  axis.title = std::move(title);
  if (scale == Scale::logarithmic) {
    axis.low = std::max(axis.low, 1.0 / kLargest);
    axis.high = std::max(axis.high, axis.low);
    make_logarithmic(axis, std::max(2, wanted));
  } else {
    make_linear(axis, std::max(2, wanted));
  }
  return axis;
}

void Extent::add(double value, bool positive) {
  if (!std::isfinite(value) || (positive && !(value > 0.0))) return;
  if (empty()) low = high = value;
  low = std::min(low, value);
  high = std::max(high, value);
}

void Extent::add(std::span<const double> values, bool positive) {
  for (const double value : values) add(value, positive);
}

}  // namespace bodeflow::tools::report
