#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <vector>

/// The examples of the paper, simulated.
namespace bodeflow::test {

/// Clean records of a system with polynomials a (1, a_1 ..) and b, after `before` samples that are dropped.
struct Records {
  Eigen::VectorXd input;
  Eigen::VectorXd output;
};

inline Eigen::VectorXd filtered(const Eigen::VectorXd& b, const Eigen::VectorXd& a, const Eigen::VectorXd& u) {
  Eigen::VectorXd y(u.size());
  for (Eigen::Index t = 0; t < u.size(); ++t) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < b.size() && i <= t; ++i) sum += b[i] * u[t - i];
    for (Eigen::Index i = 1; i < a.size() && i <= t; ++i) sum -= a[i] * y[t - i];
    y[t] = sum;
  }
  return y;
}

template <class Next>
Records simulated(const Eigen::VectorXd& b, const Eigen::VectorXd& a, Eigen::Index samples, Eigen::Index before,
                  Next&& next_input) {
  Eigen::VectorXd u(before + samples);
  for (double& value : u) value = next_input();
  const Eigen::VectorXd y = filtered(b, a, u);
  return {u.tail(samples), y.tail(samples)};
}

struct Example1 {
  Eigen::Vector3d a{1.0, -0.5, 0.3};
  Eigen::Vector3d b{2.0, -1.2, -0.6};
  double input_noise = 0.1;
  double ratio = 6.0;

  Records clean(numerics::Random& random, Eigen::Index samples) const {
    return simulated(b, a, samples, 100, [&] { return random.uniform() < 0.5 ? -1.0 : 1.0; });
  }
};

struct Example2 {
  Eigen::VectorXd a{{1.0, -3.57, 5.13, -3.5, 0.96}};
  Eigen::VectorXd b{{0.01, 0.0115, 0.0102, 0.0027, 0.0005}};
  double input_noise = 0.1;
  double ratio = 6.0;

  Records clean(numerics::Random& random, Eigen::Index samples) const {
    return simulated(b, a, samples, 2000, [&] { return random.normal(); });
  }
};

inline Eigen::VectorXd white(numerics::Random& random, Eigen::Index samples, double variance) {
  Eigen::VectorXd e(samples);
  for (double& value : e) value = std::sqrt(variance) * random.normal();
  return e;
}

inline Records noisy(const Records& clean, numerics::Random& random, double input_noise, double ratio) {
  const Eigen::Index samples = clean.input.size();
  return {clean.input + white(random, samples, input_noise), clean.output + white(random, samples, ratio * input_noise)};
}

/// Noise as the paper's authors seem to have used it: exactly zero mean, of exact variance, at right angles to both clean signals
/// and between input and output.
inline Records noisy_decorrelated(const Records& clean, numerics::Random& random, double input_noise, double ratio) {
  const Eigen::Index samples = clean.input.size();
  std::vector<Eigen::VectorXd> basis;
  const auto make_orthogonal = [&](Eigen::VectorXd v) {
    for (const auto& direction : basis) v -= direction.dot(v) * direction;
    return v;
  };
  for (const Eigen::VectorXd& v : {Eigen::VectorXd(Eigen::VectorXd::Ones(samples)), clean.input, clean.output}) {
    basis.push_back(make_orthogonal(v).normalized());
  }
  const double length = std::sqrt(static_cast<double>(samples));
  const Eigen::VectorXd u = make_orthogonal(white(random, samples, 1.0)).normalized();
  basis.push_back(u);
  const Eigen::VectorXd y = make_orthogonal(white(random, samples, 1.0)).normalized();
  return {clean.input + length * std::sqrt(input_noise) * u, clean.output + length * std::sqrt(ratio * input_noise) * y};
}

}  // namespace bodeflow::test
