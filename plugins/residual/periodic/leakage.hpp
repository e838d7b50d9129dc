#pragma once

#include <cmath>
#include <complex>
#include <numbers>

namespace bodeflow::residual {

/// The Fourier coefficient of exp(j 2 pi f n / rate) over `samples` at bin l, for x = f / rate - l / samples.
inline std::complex<double> leaked(double x, double samples) {
  const double half = std::numbers::pi * x, sine = std::sin(half);
  if (std::abs(sine) < 1e-15) return 1.0;
  return std::polar(std::sin(half * samples) / (samples * sine), half * (samples - 1.0));
}

}  // namespace bodeflow::residual
