#pragma once

#include <Eigen/Core>
#include <complex>

namespace bodeflow::koopmans_levin {

/// Fills z^n .. z 1 at z = exp(-i omega), n + 1 = the size of `powers`. By products: good to n roundings.
inline void fill_powers(double omega, Eigen::VectorXcd& powers) {
  const std::complex<double> z = std::polar(1.0, -omega);
  powers[powers.size() - 1] = 1.0;
  for (Eigen::Index i = powers.size() - 1; i > 0; --i) powers[i - 1] = powers[i] * z;
}

/// [z^n .. z 1] at z = exp(-i omega).
inline Eigen::VectorXcd powers_at(double omega, Eigen::Index order) {
  Eigen::VectorXcd powers(order + 1);
  fill_powers(omega, powers);
  return powers;
}

/// c_0 + c_1 z + .. by Horner's rule.
inline std::complex<double> ascending(const Eigen::VectorXd& coefficients, std::complex<double> z) {
  std::complex<double> sum = 0.0;
  for (Eigen::Index i = coefficients.size() - 1; i >= 0; --i) sum = sum * z + coefficients[i];
  return sum;
}

}  // namespace bodeflow::koopmans_levin
