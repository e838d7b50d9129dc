#pragma once

#include <Eigen/Core>
#include <bodeflow/numerics/fft.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <vector>

namespace bodeflow::test {

using Complex = std::complex<double>;

/// first, first + step ... up to last.
inline std::vector<std::int64_t> lines_of(std::int64_t first, std::int64_t last, std::int64_t step = 1) {
  std::vector<std::int64_t> lines;
  for (std::int64_t k = first; k <= last; k += step) lines.push_back(k);
  return lines;
}

/// N samples of sum_k amplitude cos(2 pi k n / N + phase), phases from `random`.
inline Eigen::VectorXd random_multisine(int N, const std::vector<std::int64_t>& lines, double amplitude,
                                        numerics::Random& random) {
  numerics::ComplexDft dft(N);
  Eigen::VectorXcd X = Eigen::VectorXcd::Zero(N), x(N);
  for (const std::int64_t k : lines) {
    X[k] = std::polar(0.5 * amplitude * N, 2.0 * M_PI * random.uniform());
    X[N - k] = std::conj(X[k]);
  }
  dft.inverse(X, x);
  return x.real();
}

/// The steady-state answer of G(k) to a period: circular filtering.
inline Eigen::VectorXd filtered(const Eigen::VectorXd& x, const std::function<Complex(int)>& G) {
  const auto N = x.size();
  Eigen::VectorXcd X = numerics::dft(x);
  for (Eigen::Index k = 0; k <= N / 2; ++k) {
    X[k] *= 2 * k == N ? G(static_cast<int>(k)).real() : G(static_cast<int>(k));
    if (k > 0 && 2 * k < N) X[N - k] = std::conj(X[k]);
  }
  X[0] = X[0].real();
  return numerics::inverse_dft(X).real();
}

/// White noise of that standard deviation.
inline Eigen::VectorXd noise(Eigen::Index count, double deviation, numerics::Random& random) {
  Eigen::VectorXd x(count);
  for (double& v : x) v = deviation * random.normal();
  return x;
}

/// A resonance at line k0 of N, a drop above it.
inline std::function<Complex(int)> resonance(double k0, double damping) {
  return [=](int k) { return 1.0 / (1.0 - std::pow(k / k0, 2) + Complex(0.0, 2.0 * damping * k / k0)); };
}

}  // namespace bodeflow::test
