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
/// at which no T is left. The rate comes from the first and last time, rounded to what the written digits can tell.
class Sampling {
 public:
  /// How far a time may lie from its place, in sampling intervals.
  static constexpr double kTolerance = 0.1;

  /// Takes the next time, in seconds; `resolution_s`: the place value of its last written digit. What is wrong, or nothing.
  std::optional<std::string> add(double time_s, double resolution_s);

  /// Seconds per sample, of at least two times; 0 before.
  double interval_s() const;

  /// 1 / interval as a fraction; unknown before two times.
  Rate rate() const;

  /// Whether the times agree with this rate.
  bool agrees_with(double rate_hz) const;

 private:
  std::string describe_step(double step) const;

  std::int64_t count_ = 0;
  double first_ = 0.0, last_ = 0.0;
  double least_ = 0.0, greatest_ = 0.0;  // range of T, in seconds
  double resolution_ = 0.0;              // the finest seen
};

/// "0.0004" and the like: the shortest digits that read back as the value.
std::string number_text(double value);

/// The same with at most six significant digits, for people.
std::string short_text(double value);

}  // namespace bodeflow::acquisition
