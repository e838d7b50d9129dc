#include "partial_fractions.hpp"

#include <algorithm>
#include <bodeflow/numerics/polynomial.hpp>

namespace bodeflow::sanathanan_koerner {

using Complex = std::complex<double>;

namespace {

/// 1 / (x + j y), where neither square overflows: rates below 1e150 rad/s.
Complex inverse(double x, double y) {
  const double square = x * x + y * y;
  return {x / square, -y / square};
}

}  // namespace

Expected<PoleSet> pole_set(const Eigen::VectorXcd& poles) {
  const auto split = numerics::split_roots(poles);
  if (!split) return unexpected("the poles: " + split.error().text);
  return PoleSet{split->pairs, split->real};
}

Eigen::VectorXcd all_poles(const PoleSet& poles) {
  Eigen::VectorXcd all(poles.order());
  Eigen::Index n = 0;
  for (const Complex p : poles.pairs) {
    all[n++] = p;
    all[n++] = std::conj(p);
  }
  for (const double p : poles.real) all[n++] = p;
  return all;
}

Eigen::MatrixXcd partial_fractions_at(const PoleSet& poles, const Eigen::VectorXd& omega) {
  Eigen::MatrixXcd f(omega.size(), poles.order() + 1);
  Eigen::Index n = 0;
  for (const Complex p : poles.pairs) {
    for (Eigen::Index k = 0; k < omega.size(); ++k) {
      const Complex above = inverse(-p.real(), omega[k] - p.imag()), below = inverse(-p.real(), omega[k] + p.imag());
      f(k, n) = above + below;
      f(k, n + 1) = {below.imag() - above.imag(), above.real() - below.real()};  // j (above - below)
    }
    n += 2;
  }
  for (const double p : poles.real) {
    for (Eigen::Index k = 0; k < omega.size(); ++k) f(k, n) = inverse(-p, omega[k]);
    ++n;
  }
  f.col(n).setOnes();
  return f;
}

Eigen::MatrixXcd response(const PartialFractions& m, const Eigen::VectorXd& omega) {
  return partial_fractions_at(m.poles, omega) * m.coefficients.cast<Complex>();
}

Eigen::MatrixXcd residues(const PartialFractions& m) {
  Eigen::MatrixXcd r(m.poles.order(), m.channels());
  const auto pairs = static_cast<Eigen::Index>(m.poles.pairs.size());
  for (Eigen::Index n = 0; n < pairs; ++n) {
    r.row(2 * n).real() = m.coefficients.row(2 * n);
    r.row(2 * n).imag() = m.coefficients.row(2 * n + 1);
    r.row(2 * n + 1) = r.row(2 * n).conjugate();
  }
  for (Eigen::Index n = 2 * pairs; n < r.rows(); ++n) r.row(n) = m.coefficients.row(n).cast<Complex>();
  return r;
}

ModalPair modal_pair(const PoleSet& poles) {
  const Eigen::Index M = poles.order();
  ModalPair m{Eigen::MatrixXd::Zero(M, M), Eigen::VectorXd::Zero(M)};
  Eigen::Index n = 0;
  for (const Complex p : poles.pairs) {
    m.A.block(n, n, 2, 2) << p.real(), p.imag(), -p.imag(), p.real();
    m.b[n] = 2.0;
    n += 2;
  }
  for (const double p : poles.real) {
    m.A(n, n) = p;
    m.b[n++] = 1.0;
  }
  return m;
}

numerics::StateSpace state_space(const PartialFractions& m) {
  const Eigen::Index M = m.poles.order();
  ModalPair modal = modal_pair(m.poles);
  return {std::move(modal.A), std::move(modal.b), m.coefficients.topRows(M).transpose(), m.coefficients.row(M).transpose(), 0.0};
}

}  // namespace bodeflow::sanathanan_koerner
