#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <bodeflow/numerics/fft.hpp>
#include <complex>

namespace bodeflow::residual {

/// The real periodic signal of `samples` values with these Fourier coefficients (lines 0 ...); the line at half the sample rate
/// is left out.
inline Eigen::VectorXd signal_of(const Eigen::VectorXcd& lines, Eigen::Index samples) {
  Eigen::VectorXcd full = Eigen::VectorXcd::Zero(samples);
  const auto size = static_cast<double>(samples);
  full[0] = lines[0].real() * size;
  for (Eigen::Index k = 1; k < std::min(lines.size(), (samples + 1) / 2); ++k) {
    full[k] = lines[k] * size;
    full[samples - k] = std::conj(full[k]);
  }
  return numerics::inverse_dft(full).real();
}

/// The Fourier coefficients of a period, from zero frequency up.
inline Eigen::VectorXcd coefficients(const Eigen::VectorXd& signal) {
  return numerics::half_dft(signal) / static_cast<double>(signal.size());
}

}  // namespace bodeflow::residual
