#pragma once

#include <bodeflow/numerics/error.hpp>
#include <cstddef>
#include <span>
#include <vector>

namespace bodeflow::drive {

/// A first-order lag and a transport delay, exp(-s delay) / (1 + s lag), for one channel of a sampled stream; the past before the
/// first sample is zero.
///
/// Method: y[n] = a y[n-1] + sum_k h_k x[n - m - k] with a = exp(-1 / lag) (times in samples) and six taps for which the response
/// is exact at zero frequency, value and slope, and at 0.06 and 0.095 of the sampling rate. m centres the taps on the delay as
/// far as causality allows. Up to a tenth of the sampling rate the response is right to 8e-5 of its size, up to a hundredth to
/// 5e-6, for any lag and delay. A kink of the signal, its slope changing by d a sample, is followed with an error of at most 0.26
/// d that dies within five samples (or with the lag).
class SensorDynamics {
 public:
  /// Lag and delay in samples, each from 0 to kLongest. No lag and a whole delay shift the samples and change nothing in them.
  /// Errors: values outside.
  static numerics::Expected<SensorDynamics> make(double lag, double delay);
  static constexpr double kLongest = 1e6;

  /// y.size() = x.size(); both may be the same memory.
  void run(std::span<const double> x, std::span<double> y);
  void reset();

 private:
  SensorDynamics(double decay, std::vector<double> taps, std::size_t shift);

  double decay_;              // a
  std::vector<double> taps_;  // h, for x[n - shift_], x[n - shift_ - 1], ...
  std::size_t shift_;         // m
  std::vector<double> past_;  // ring of the last shift_ + taps_.size() samples
  std::size_t newest_ = 0;
  double output_ = 0.0;  // y[n-1]
};

}  // namespace bodeflow::drive
