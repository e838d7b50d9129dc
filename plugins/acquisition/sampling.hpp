#pragma once

#include <bodeflow/rate.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace bodeflow::acquisition {

/// Checks that rising times are equally spaced, and finds their rate; in one pass and constant memory.
///
/// Times t_0, t_1 ... are equally spaced with the interval T when every |t_n - t_0 - n T| <= 0.1 T: rounded time stamps and
/// jitter pass, a lost sample does not. The check keeps the range of T for which this holds; it is empty from the first row on
/// at which no T is left.
///
/// The interval is the slope of the least-squares line through all (n, t_n): with white jitter of the standard deviation s its
/// own is s sqrt(12 / N^3), that of first and last time s sqrt(2) / N. It is rounded to the fewest digits, of itself or of its
/// inverse, that lie within what the data can tell: the larger of two such standard deviations and the error that the rounding
/// of the written times can make.
class Sampling {
 public:
  /// How far a time may lie from its place, in sampling intervals.
  static constexpr double kTolerance = 0.1;

  /// Takes the next time, in seconds. What is wrong, or nothing.
  std::optional<std::string> add(double time_s);

  /// Seconds per sample, of at least two times; 0 before.
  double interval_s() const;

  /// 1 / interval as a fraction, for times written to the place value `resolution_s`; unknown before two times.
  Rate rate(double resolution_s) const;

  /// Whether the times agree with this rate.
  bool agrees_with(double rate_hz) const;

 private:
  std::string describe_step(double step) const;
  /// The standard deviation of `interval_s`, from the distances to the line.
  double interval_deviation_s() const;

  std::int64_t count_ = 0;
  double first_ = 0.0, last_ = 0.0;
  double least_ = 0.0, greatest_ = 0.0;                 // range of T, in seconds
  double step_ = 0.0;                                   // the first one; sums are of r_n = t_n - t_0 - n step_
  double sum_ = 0.0, sum_n_ = 0.0, sum_squares_ = 0.0;  // of r_n, n r_n, r_n^2
};

/// "0.0004" and the like: the shortest digits that read back as the value.
std::string number_text(double value);

/// The same with at most six significant digits, for people.
std::string short_text(double value);

}  // namespace bodeflow::acquisition
