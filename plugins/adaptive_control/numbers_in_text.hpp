#pragma once

#include <complex>
#include <cstdio>
#include <string>

namespace bodeflow::adaptive_control {

/// The number with six digits.
inline std::string text_of(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", value);
  return digits;
}

/// "a + b i"; a real value without the imaginary part.
inline std::string text_of(std::complex<double> value) {
  if (value.imag() == 0.0) return text_of(value.real());
  return text_of(value.real()) + (value.imag() < 0.0 ? " - " : " + ") + text_of(std::abs(value.imag())) + " i";
}

}  // namespace bodeflow::adaptive_control
