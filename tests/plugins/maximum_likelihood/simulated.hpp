#pragma once

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "maximum_likelihood/identification.hpp"

namespace bodeflow::test {

using Complex = std::complex<double>;
using maximum_likelihood::Rational;
using maximum_likelihood::Spectra;

inline Eigen::VectorXcd list(const std::vector<Complex>& values) {
  return Eigen::Map<const Eigen::VectorXcd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Frequencies f_1 .. f_K in equal ratios, in rad/s.
inline Eigen::VectorXd log_spaced(double low_hz, double high_hz, Eigen::Index count) {
  Eigen::VectorXd w(count);
  for (Eigen::Index k = 0; k < count; ++k)
    w[k] = 2.0 * std::numbers::pi * low_hz * std::pow(high_hz / low_hz, static_cast<double>(k) / static_cast<double>(count - 1));
  return w;
}

inline Eigen::VectorXd even_spaced(double low_rad_s, double high_rad_s, Eigen::Index count) {
  return Eigen::VectorXd::LinSpaced(count, low_rad_s, high_rad_s);
}

inline Eigen::MatrixXcd response_of(const Rational& model, const Eigen::VectorXd& omega) {
  return omega.unaryExpr([&](double w) { return model.response(w); });
}

/// n poles with damping .05 (of an odd order one is real) and n - 1 zeros between them, spread over the band of `omega`.
inline Rational ladder(Eigen::Index order, const Eigen::VectorXd& omega, double sample_time_s, double delay_s) {
  const double low = omega[0], high = omega[omega.size() - 1];
  const auto at = [&](double share) { return low * std::pow(high / low, 0.15 + 0.7 * share); };
  const auto place = [&](Complex s) { return sample_time_s > 0.0 ? std::exp(s * sample_time_s) : s; };
  std::vector<Complex> poles, zeros;
  const auto n = static_cast<double>(order);
  for (Eigen::Index i = 0; i + 1 < order; i += 2) {
    const Complex p = place(at((static_cast<double>(i) + 0.5) / n) * Complex(-0.05, 1.0));
    poles.insert(poles.end(), {p, std::conj(p)});
  }
  if (order % 2 == 1) poles.push_back(place(-at(0.9)));
  for (Eigen::Index i = 0; i + 2 < order; i += 2) {
    const Complex z = place(at((static_cast<double>(i) + 1.5) / n) * Complex(-0.03, 1.0));
    zeros.insert(zeros.end(), {z, std::conj(z)});
  }
  if (order % 2 == 0) zeros.push_back(place(-at(0.4)));
  Rational model{list(poles), list(zeros), 1.0, delay_s, sample_time_s};
  model.gain = 3.0 / std::abs(model.response(at(0.3)));
  return model;
}

/// The noise of an experiment, as it is on mean spectra of |U| = 1.
struct NoiseLevel {
  double input = 0.0, output = 0.0;  ///< standard deviations of U and Y
  double correlation = 0.0;          ///< real, of dY and dU
};

inline Complex normal(numerics::Random& random) { return Complex(random.normal(), random.normal()) / std::sqrt(2.0); }

/// Mean spectra of |U| = 1 at random phases with the covariance that they have.
inline Spectra measured(const Rational& model, const Eigen::VectorXd& omega, const NoiseLevel& noise, numerics::Random& random) {
  const Eigen::Index lines = omega.size();
  Spectra s = maximum_likelihood::spectra_of(omega, response_of(model, omega), Eigen::MatrixXd::Zero(lines, 1));
  for (Eigen::Index k = 0; k < lines; ++k) {
    const Complex u = std::polar(1.0, 2.0 * std::numbers::pi * random.uniform());
    const Complex a = normal(random), b = normal(random);
    const double c = noise.correlation;
    s.output(k, 0) = s.output(k, 0) * u + noise.output * (c * a + std::sqrt(1.0 - c * c) * b);
    s.input[k] = u + noise.input * a;
    s.input_variance[k] = noise.input * noise.input;
    s.output_variance(k, 0) = noise.output * noise.output;
    s.covariance(k, 0) = c * noise.input * noise.output;
  }
  s.sample_time_s = model.sample_time_s;
  return s;
}

/// The same from the mean over P periods and the scatter between them.
inline Spectra measured_over(int periods, const Rational& model, const Eigen::VectorXd& omega, const NoiseLevel& noise,
                             numerics::Random& random) {
  const Eigen::Index lines = omega.size();
  const auto count = static_cast<double>(periods);
  Spectra s = maximum_likelihood::spectra_of(omega, response_of(model, omega), Eigen::MatrixXd::Zero(lines, 1));
  for (Eigen::Index k = 0; k < lines; ++k) {
    Eigen::VectorXcd u(periods), y(periods);
    for (Eigen::Index p = 0; p < periods; ++p) {
      const Complex a = normal(random), b = normal(random);
      u[p] = 1.0 + std::sqrt(count) * noise.input * a;
      y[p] = s.output(k, 0) + std::sqrt(count) * noise.output * b;
    }
    s.input[k] = u.mean();
    s.output(k, 0) = y.mean();
    const Eigen::VectorXcd du = u.array() - u.mean(), dy = y.array() - y.mean();
    const double by = 1.0 / (count * (count - 1.0));
    s.input_variance[k] = by * du.squaredNorm();
    s.output_variance(k, 0) = by * dy.squaredNorm();
    s.covariance(k, 0) = by * du.dot(dy);
  }
  s.degrees_of_freedom = count - 1.0;
  return s;
}

inline maximum_likelihood::Settings settings(maximum_likelihood::Domain domain, Eigen::Index order) {
  maximum_likelihood::Settings s;
  s.domain = domain;
  s.order = order;
  return s;
}

/// max |found - true| / |true| over the lines.
inline double response_error(const Rational& found, const Rational& truth, const Eigen::VectorXd& omega) {
  double worst = 0.0;
  for (const double w : omega) worst = std::max(worst, std::abs(found.response(w) / truth.response(w) - 1.0));
  return worst;
}

/// The largest relative distance of a true root from the nearest one found.
inline double root_error(const Eigen::VectorXcd& found, const Eigen::VectorXcd& truth) {
  double worst = 0.0;
  for (const Complex root : truth) worst = std::max(worst, (found.array() - root).abs().minCoeff() / std::abs(root));
  return worst;
}

}  // namespace bodeflow::test
