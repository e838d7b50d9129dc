#pragma once

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <string>

#include "records/model.hpp"

namespace bodeflow::test {

/// y[n] = 1.5 y[n-1] - 0.7 y[n-2] + 0.4 u[n-1] + 0.2 u[n-2] at 100 Hz.
inline records::ModelData second_order() {
  records::ModelData m;
  m.method = "hand";
  m.form = "transfer_function";
  m.order = 2;
  m.sample_time_s = 0.01;
  m.parameter_names = {"a1", "a2", "b1", "b2"};
  m.parameter_units = {"1", "1", "A/V", "A/V"};
  m.parameters = Eigen::Vector4d(-1.5, 0.7, 0.4, 0.2);
  m.covariance = Eigen::Vector4d(1e-4, 1e-4, 4e-4, 4e-4).asDiagonal();
  m.numerator = Eigen::Vector2d(0.4, 0.2);
  m.denominator = Eigen::Vector3d(1.0, -1.5, 0.7);
  m.input_unit = "V";
  m.output_unit = "A";
  return m;
}

inline Eigen::VectorXd white(Eigen::Index samples, std::uint64_t seed, double std = 1.0) {
  numerics::Random random(seed);
  Eigen::VectorXd x(samples);
  for (double& v : x) v = std * random.normal();
  return x;
}

/// The output of `second_order` at rest.
inline Eigen::VectorXd response_to(const Eigen::VectorXd& u) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(u.size());
  for (Eigen::Index n = 1; n < u.size(); ++n) {
    y[n] = 1.5 * y[n - 1] + 0.4 * u[n - 1];
    if (n > 1) y[n] += -0.7 * y[n - 2] + 0.2 * u[n - 2];
  }
  return y;
}

/// e[n] = c e[n-1] + w[n], in its steady state from the first sample on.
inline Eigen::VectorXd coloured(Eigen::Index samples, double c, std::uint64_t seed, double std = 1.0) {
  Eigen::VectorXd e = white(samples, seed, std);
  e[0] /= std::sqrt(1.0 - c * c);
  for (Eigen::Index n = 1; n < samples; ++n) e[n] += c * e[n - 1];
  return e;
}

}  // namespace bodeflow::test
