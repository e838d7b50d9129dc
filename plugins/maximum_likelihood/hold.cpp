#include "hold.hpp"

#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

Expected<Eigen::VectorXcd> held_response(const Eigen::VectorXd& omega_rad_s, double sample_time_s, const Rational& model) {
  const auto system = numerics::to_state_space(numerics::ZeroPoleGain{model.zeros, model.poles, model.gain, 0.0});
  if (!system) return refusal_in(system);
  const auto held = numerics::zero_order_hold(*system, sample_time_s, model.delay_s);
  if (!held) return refusal_in(held);
  const auto matrices = numerics::frequency_response(held->model, omega_rad_s / (2.0 * std::numbers::pi));
  Eigen::VectorXcd g(omega_rad_s.size());
  for (Eigen::Index k = 0; k < g.size(); ++k) {
    const double turn = omega_rad_s[k] * sample_time_s * static_cast<double>(held->delay);
    g[k] = matrices[static_cast<std::size_t>(k)](0, 0) * std::polar(1.0, -turn);
  }
  return g;
}

}  // namespace

Complex hold_factor(double omega_rad_s, double sample_time_s) {
  const double half = 0.5 * omega_rad_s * sample_time_s;
  return half == 0.0 ? Complex(1.0) : std::polar(std::sin(half) / half, -half);
}

Expected<Eigen::MatrixXcd> images(const Eigen::VectorXd& omega_rad_s, double sample_time_s, const std::vector<Rational>& models) {
  Eigen::MatrixXcd added(omega_rad_s.size(), static_cast<Eigen::Index>(models.size()));
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto held = held_response(omega_rad_s, sample_time_s, models[i]);
    if (!held) return refusal_in(held);
    for (Eigen::Index k = 0; k < omega_rad_s.size(); ++k) {
      const Complex alone = hold_factor(omega_rad_s[k], sample_time_s) * models[i].response(omega_rad_s[k]);
      added(k, static_cast<Eigen::Index>(i)) = (*held)[k] - alone;
    }
  }
  if (!added.allFinite()) return refused("a line lies on a pole of the held model");
  return added;
}

void remove_hold(Lines& lines, const Spectra& s, const Structure& structure, const Eigen::MatrixXcd& images) {
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    Channel& c = lines.channels[i];
    const auto column = static_cast<Eigen::Index>(i);
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      const Complex hold = hold_factor(lines.omega_rad_s[k], s.sample_time_s), image = images(k, column);
      Complex factor = 1.0;
      for (const Complex pole : structure.fixed_poles) factor *= lines.points[k] - pole / lines.scale;
      const double variance = s.output_variance(k, column) + std::norm(image) * s.input_variance[k] -
                              2.0 * std::real(std::conj(image) * s.covariance(k, column));
      c.input[k] = hold * s.input[k];
      c.input_variance[k] = std::norm(hold) * s.input_variance[k];
      c.output[k] = factor * (s.output(k, column) - image * s.input[k]);
      c.output_variance[k] = std::norm(factor) * variance;
      c.covariance[k] = factor * std::conj(hold) * (s.covariance(k, column) - image * s.input_variance[k]);
    }
  }
}

}  // namespace bodeflow::maximum_likelihood
