#include "bodeflow/numerics/balance.hpp"

#include <cmath>

namespace bodeflow::numerics {
namespace {

// A step must lower the sum of both norms by this factor to be taken: LAPACK's choice (dgebal), it keeps the sweeps few.
constexpr double kWorthwhile = 0.95;
constexpr int kMaxSweeps = 100;

double off_diagonal(const Eigen::MatrixXd& m, Eigen::Index i, bool row) {
  return (row ? m.row(i).cwiseAbs().sum() : m.col(i).cwiseAbs().sum()) - std::abs(m(i, i));
}

}  // namespace

Eigen::VectorXd balancing_scales(const Eigen::MatrixXd& matrix) {
  Eigen::MatrixXd m = matrix;
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(m.rows());
  bool changed = true;
  for (int sweep = 0; changed && sweep < kMaxSweeps; ++sweep) {
    changed = false;
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      const double column = off_diagonal(m, i, false);
      const double row = off_diagonal(m, i, true);
      if (!(column > 0) || !(row > 0)) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (column * factor + row / factor >= kWorthwhile * (column + row)) continue;
      scales[i] *= factor;
      m.col(i) *= factor;
      m.row(i) /= factor;
      changed = true;
    }
  }
  return scales;
}

Eigen::MatrixXd scaled_by(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& scales) {
  return scales.cwiseInverse().asDiagonal() * matrix * scales.asDiagonal();
}

}  // namespace bodeflow::numerics
