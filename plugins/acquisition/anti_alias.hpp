#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <span>

namespace bodeflow::acquisition {

/// The continuous-time Butterworth low-pass of this order: |H(j 2 pi f)|^2 = 1 / (1 + (f / corner)^(2 order)), gain 1 at zero
/// frequency, -3 dB at the corner. order: 1 to 12; corner_hz > 0.
/// Reference: S. Butterworth, On the theory of filter amplifiers, 1930.
numerics::Expected<numerics::StateSpace> butterworth(int order, double corner_hz);

/// An analog filter of one channel, simulated at the samples of its input, which is held over each sampling interval: exact at
/// these times (numerics::zero_order_hold). At rest before the first sample. Allocates nothing after it is made.
class AnalogFilter {
 public:
  /// model: one input, one output, no feed-through, discretised.
  explicit AnalogFilter(numerics::StateSpace model);

  /// y[n] = C x[n], x[n + 1] = A x[n] + B u[n]. The same memory may hold u and y.
  void run(std::span<const double> u, std::span<double> y);
  void reset() { state_.setZero(); }

 private:
  numerics::StateSpace model_;
  Eigen::VectorXd state_, next_;
};

}  // namespace bodeflow::acquisition
