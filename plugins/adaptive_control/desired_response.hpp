#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <complex>
#include <vector>

namespace bodeflow::adaptive_control {

using numerics::Expected;
using numerics::refused;

/// Unit gain over a characteristic polynomial with a delay: G_m(s) = A_m(0) / A_m(s) exp(-s tau) (7.3), and the observer
/// polynomial that goes with it, both in s, monic, in descending powers.
struct DesiredResponse {
  Eigen::VectorXd a_m;
  Eigen::VectorXd a_o;
  double delay_s = 0.0;
};

/// The same demands with all poles of A_m and A_o `factor` times as fast; the delay stays.
DesiredResponse scaled(const DesiredResponse& desired, double factor);

/// G(z) of a continuous-time plant or desired response behind a zero-order hold, at z = exp(i omega h): exact, with a delay that
/// need not be whole. `omega` in rad/s. Errors: those of numerics::zero_order_hold; a pole at one of the points.
Expected<std::vector<std::complex<double>>> sampled_response(const numerics::TransferFunction& plant, double delay_s,
                                                             double sample_time, const std::vector<double>& omega);

/// G_m at the points. Errors: a pole of A_m that is not in the open left half plane, and those of sampled_response.
Expected<std::vector<std::complex<double>>> desired_points(const DesiredResponse& desired, double sample_time,
                                                           const std::vector<double>& omega);

/// A_o(z): the poles of A_o(s) taken to z = exp(s h), monic, descending powers. Errors: a pole that is not in the open left half
/// plane, coefficients that are not finite.
Expected<Eigen::VectorXd> sampled_observer(const Eigen::VectorXd& a_o, double sample_time);

/// G_m as a transfer function in s without the delay.
numerics::TransferFunction undelayed(const DesiredResponse& desired);

}  // namespace bodeflow::adaptive_control
