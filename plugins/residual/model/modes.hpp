#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

namespace bodeflow::residual {

/// The product and the reciprocal of finite complex numbers, without the care for infinities that makes the operators slow.
inline std::complex<double> times(std::complex<double> a, std::complex<double> b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
inline std::complex<double> reciprocal(std::complex<double> a) {
  const double per = 1.0 / (a.real() * a.real() + a.imag() * a.imag());
  return {a.real() * per, -a.imag() * per};
}

/// The modes of a square matrix: A = vectors diag(poles) vectors^-1.
struct Modes {
  Eigen::VectorXcd poles;
  Eigen::MatrixXcd vectors, inverse;
};

/// The modes; nothing where the vectors stand so near to each other (condition above 1e6) that digits would be lost.
std::optional<Modes> modes_of(const Eigen::MatrixXd& a);

/// D + C (x I - A)^-1 B for many x: by modes where there are any, else by one factorisation each.
class Resolvent {
 public:
  Resolvent() = default;
  Resolvent(const Eigen::MatrixXd& a, const std::optional<Modes>& modes, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c);

  /// C (x I - A)^-1 B.
  void at(std::complex<double> x, Eigen::MatrixXcd& result) const;

 private:
  Eigen::MatrixXd a_;
  Eigen::VectorXcd poles_;
  Eigen::MatrixXcd b_, c_;
  bool modal_ = false;
};

}  // namespace bodeflow::residual
