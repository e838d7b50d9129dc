#include "model/modes.hpp"

#include <Eigen/Dense>

namespace bodeflow::residual {
namespace {

constexpr double kWorst = 1e6;

}  // namespace

std::optional<Modes> modes_of(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) return {};
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(a);
  if (solver.info() != Eigen::Success) return {};
  Modes m;
  m.poles = solver.eigenvalues();
  m.vectors = solver.eigenvectors();
  m.inverse = m.vectors.partialPivLu().inverse();
  if (!(m.vectors.norm() * m.inverse.norm() < kWorst)) return {};
  return m;
}

Resolvent::Resolvent(const Eigen::MatrixXd& a, const std::optional<Modes>& modes, const Eigen::MatrixXd& b,
                     const Eigen::MatrixXd& c)
    : a_(a), b_(b.cast<std::complex<double>>()), c_(c.cast<std::complex<double>>()), modal_(modes.has_value()) {
  if (!modal_) return;
  poles_ = modes->poles;
  b_ = (modes->inverse * b_).eval();
  c_ = (c_ * modes->vectors).eval();
}

void Resolvent::at(std::complex<double> x, Eigen::MatrixXcd& result) const {
  result.setZero(c_.rows(), b_.cols());
  if (modal_) {
    for (Eigen::Index i = 0; i < poles_.size(); ++i) {
      const std::complex<double> factor = reciprocal(x - poles_[i]);
      for (Eigen::Index column = 0; column < b_.cols(); ++column) {
        const std::complex<double> pushed = times(factor, b_(i, column));
        for (Eigen::Index row = 0; row < c_.rows(); ++row) result(row, column) += times(c_(row, i), pushed);
      }
    }
  } else if (a_.rows() > 0) {
    Eigen::MatrixXcd m = -a_.cast<std::complex<double>>();
    m.diagonal().array() += x;
    result.noalias() = c_ * m.partialPivLu().solve(b_);
  }
}

}  // namespace bodeflow::residual
