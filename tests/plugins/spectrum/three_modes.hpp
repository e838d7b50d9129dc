#pragma once

#include <Eigen/Core>
#include <array>
#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <cmath>
#include <complex>

namespace bodeflow::test {

/// A plant with three lightly damped modes at 2, 5 and 9 rad/s, damping ratios 0.02, 0.03 and 0.01, each with a gain of one at
/// rest: G(s) = sum_i w_i^2 / (s^2 + 2 zeta_i w_i s + w_i^2), its input held over each sample; simulated exactly.
class ThreeModes {
 public:
  explicit ThreeModes(double sample_time) {
    constexpr std::array<double, 3> kOmega{2.0, 5.0, 9.0}, kDamping{0.02, 0.03, 0.01};
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      const double w = kOmega[i];
      const numerics::StateSpace mode{(Eigen::Matrix2d() << 0.0, 1.0, -w * w, -2.0 * kDamping[i] * w).finished(),
                                      Eigen::Vector2d(0.0, w * w), Eigen::RowVector2d(1.0, 0.0), Eigen::MatrixXd::Zero(1, 1)};
      const numerics::StateSpace held = numerics::zero_order_hold(mode, sample_time).value().model;
      modes_[i] = {held.A, held.B, Eigen::Vector2d::Zero()};
    }
  }

  /// y[n] for u[n]; the state moves on.
  double step(double u) {
    double y = 0.0;
    for (Mode& mode : modes_) {
      y += mode.state[0];
      mode.state = (mode.a * mode.state + mode.b * u).eval();
    }
    return y;
  }

  /// The response of the sampled plant at `angle` radians a sample.
  std::complex<double> response(double angle) const {
    const std::complex<double> z = std::polar(1.0, angle);
    std::complex<double> g = 0.0;
    for (const Mode& mode : modes_) {
      const auto determinant = (z - mode.a(0, 0)) * (z - mode.a(1, 1)) - mode.a(0, 1) * mode.a(1, 0);
      g += ((z - mode.a(1, 1)) * mode.b[0] + mode.a(0, 1) * mode.b[1]) / determinant;
    }
    return g;
  }

 private:
  struct Mode {
    Eigen::Matrix2d a;
    Eigen::Vector2d b, state;
  };
  std::array<Mode, 3> modes_;
};

}  // namespace bodeflow::test
