#include "sampling.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bodeflow::acquisition {
namespace {

// Times near each other in value lose digits: a spacing is not known better than this, relative.
constexpr double kFinest = 1e-12;
// A step of this many intervals or more has lost samples in it; a shorter one is jitter.
constexpr double kGap = 1.5;

/// `value` with as few significant digits as lie within `tolerance` of it (relative), and how many these are.
double roundest(double value, double tolerance, int& digits) {
  for (digits = 1; digits < 17; ++digits) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1).ptr;
    double rounded = 0.0;
    std::from_chars(text, end, rounded);
    if (std::abs(rounded - value) <= tolerance * value) return rounded;
  }
  return value;
}

}  // namespace

std::string number_text(double value) {
  char text[40];
  const bool plain = std::abs(value) >= 1e-4 && std::abs(value) < 1e15;  // 100000 rather than 1e+05
  const auto end = plain ? std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr
                         : std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string short_text(double value) {
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr;
  return {text, end};
}

std::string Sampling::describe_step(double step) const {
  const double expected = (last_ - first_) / static_cast<double>(count_ - 1);
  int digits = 0;
  const std::string steps = number_text(roundest(step, 1e-6, digits)) + " s";
  const std::string interval = number_text(roundest(expected, 1e-3, digits)) + " s";
  const std::string after = " after " + short_text(last_) + " s";
  if (step >= kGap * expected) {
    const std::string lost = number_text(std::round(step / expected) - 1.0);
    return "gap of " + lost + (lost == "1" ? " sample" : " samples") + after + ": a step of " + steps + " where samples are " +
           interval + " apart";
  }
  if (std::abs(step - expected) <= kTolerance * expected) {
    return "not equally sampled: time has drifted by more than 10 % of " + interval + ", the sampling interval so far";
  }
  return "not equally sampled: a step of " + steps + after + " where samples are " + interval + " apart (tolerance 10 % of it)";
}

std::optional<std::string> Sampling::add(double time_s) {
  if (count_ == 0) {
    first_ = last_ = time_s;
    count_ = 1;
    return std::nullopt;
  }
  const double step = time_s - last_;
  if (step == 0.0) return "time " + number_text(time_s) + " s stands twice";
  if (!(step > 0.0)) return "time runs back: " + number_text(time_s) + " s after " + number_text(last_) + " s";
  const auto n = static_cast<double>(count_);
  const double elapsed = time_s - first_;
  const double least = elapsed / (n + kTolerance), greatest = elapsed / (n - kTolerance);
  if (!std::isfinite(greatest)) return "time is beyond the range of a double";
  if (count_ > 1 && (least > greatest_ || greatest < least_)) return describe_step(step);
  least_ = count_ == 1 ? least : std::max(least, least_);
  greatest_ = count_ == 1 ? greatest : std::min(greatest, greatest_);
  if (count_ == 1) step_ = step;
  const double r = elapsed - n * step_;
  sum_ += r;
  sum_n_ += n * r;
  sum_squares_ += r * r;
  last_ = time_s;
  ++count_;
  return std::nullopt;
}

double Sampling::interval_s() const {
  if (count_ < 2) return 0.0;
  const auto n = static_cast<double>(count_);
  const double spread = n * (n * n - 1.0) / 12.0;  // sum of (k - mean of k)^2
  return step_ + (sum_n_ - (n - 1.0) / 2.0 * sum_) / spread;
}

double Sampling::interval_deviation_s() const {
  if (count_ < 3) return 0.0;
  const auto n = static_cast<double>(count_);
  const double spread = n * (n * n - 1.0) / 12.0;
  const double slope = interval_s() - step_;
  const double rest = sum_squares_ - sum_ * sum_ / n - slope * slope * spread;  // sum of squared distances to the line
  return std::sqrt(std::max(rest, 0.0) / (n - 2.0) / spread);
}

Rate Sampling::rate(double resolution_s) const {
  const double interval = interval_s();
  if (!(interval > 0.0)) return {};
  // Errors of half a place each, at their worst for the slope of a line: 1.5 places over the whole length.
  const double rounding = 1.5 * resolution_s / static_cast<double>(count_ - 1);
  const double tolerance = std::max(std::max(rounding, 2.0 * interval_deviation_s()) / interval, kFinest);
  int interval_digits = 0, rate_digits = 0;
  const double round_interval = roundest(interval, tolerance, interval_digits);
  const double round_rate = roundest(1.0 / interval, tolerance, rate_digits);
  return Rate::from_hz(interval_digits <= rate_digits ? 1.0 / round_interval : round_rate);
}

bool Sampling::agrees_with(double rate_hz) const {
  if (count_ < 2) return true;
  const double interval = 1.0 / rate_hz;
  return interval >= least_ && interval <= greatest_;
}

}  // namespace bodeflow::acquisition
