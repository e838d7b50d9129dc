#pragma once

#include <Eigen/Core>
#include <cmath>

namespace bodeflow::residual {

/// How a linear system dx/dt = A x + p(t) moves over a time: phi = exp(A h), and psi[k] = int_0^h exp(A (h - t)) t^k dt, what a
/// push that grows as t^k has reached.
struct Transition {
  double h = 0.0;
  Eigen::MatrixXd phi, psi[3];

  /// Over twice the time.
  Transition doubled() const {
    Transition d;
    d.h = 2.0 * h;
    d.phi.noalias() = phi * phi;
    d.psi[0] = psi[0];
    d.psi[0].noalias() += phi * psi[0];
    d.psi[1] = psi[1] + h * psi[0];
    d.psi[1].noalias() += phi * psi[1];
    d.psi[2] = psi[2] + 2.0 * h * psi[1] + h * h * psi[0];
    d.psi[2].noalias() += phi * psi[2];
    return d;
  }
};

/// The transition over h >= 0.
///
/// Method: power series of the blocks of the exponential of Van Loan (Computing integrals involving the matrix exponential, IEEE
/// Trans. Automatic Control 23, 1978) for h / 2^k with |A h| / 2^k <= 1/2, doubled k times. Cost: about 20 + 4 k products of A's
/// size.
inline Transition transition(const Eigen::MatrixXd& a, double h) {
  constexpr int kTerms = 15;  // of |A h| <= 1/2: the next one is below 1e-17
  const Eigen::Index n = a.rows();
  int halvings = 0;
  if (n > 0 && h > 0.0) {
    const double size = a.cwiseAbs().colwise().sum().maxCoeff() * h;
    if (size > 0.5) std::frexp(2.0 * size, &halvings);
  }
  Transition t;
  t.h = std::ldexp(h, -halvings);
  const Eigen::MatrixXd step = a * t.h;
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(n, n);  // (A h)^j / j!
  t.phi = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::MatrixXd& psi : t.psi) psi = Eigen::MatrixXd::Zero(n, n);
  for (int j = 0; j <= kTerms; ++j) {
    const double one = 1.0 / (j + 1), two = one / (j + 2), three = two / (j + 3);
    t.phi += power;
    t.psi[0] += (t.h * one) * power;
    t.psi[1] += (t.h * t.h * two) * power;
    t.psi[2] += (2.0 * t.h * t.h * t.h * three) * power;
    power = (power * step * one).eval();
  }
  for (int i = 0; i < halvings; ++i) t = t.doubled();
  t.h = h;
  return t;
}

}  // namespace bodeflow::residual
