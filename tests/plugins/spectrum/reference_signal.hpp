#pragma once

#include <Eigen/Core>
#include <cmath>

namespace bodeflow::test {

/// Column 0: an input of sines and a chirp with a slope, column 1: the answer of a first-order filter to it, with a disturbance.
/// The signal of the reference values that NumPy and SciPy gave (see the tests that use it):
///   n = arange(N); u = sin(0.37 n) + 0.5 cos(0.011 n^2) + 0.002 n; v = sin(1.9 n^2 + 0.3)
///   y[i] = 0.6 y[i-1] + 0.4 u[i-1] + 0.1 v[i], both zero before the first sample
inline Eigen::MatrixXd reference_signal(Eigen::Index samples) {
  Eigen::MatrixXd s(samples, 2);
  double y = 0.0, before = 0.0;
  for (Eigen::Index i = 0; i < samples; ++i) {
    const auto n = static_cast<double>(i);
    y = 0.6 * y + 0.4 * before + 0.1 * std::sin(1.9 * n * n + 0.3);
    before = std::sin(0.37 * n) + 0.5 * std::cos(0.011 * n * n) + 0.002 * n;
    s(i, 0) = before;
    s(i, 1) = y;
  }
  return s;
}

}  // namespace bodeflow::test
