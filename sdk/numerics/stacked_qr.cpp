#include "bodeflow/numerics/stacked_qr.hpp"

#include <algorithm>
#include <cmath>

#include "bodeflow/numerics/products.hpp"

namespace bodeflow::numerics {
namespace {

constexpr Eigen::Index kPanel = 24;
constexpr double kSmallSquares = 1e-200, kLargeSquares = 1e300;  // between them a sum of squares has lost nothing

using Matrix = Eigen::Ref<Eigen::MatrixXd>;

double norm(const Eigen::Ref<const Eigen::VectorXd>& x) {
  const double squares = transposed_times(x, x)[0];
  return squares > kSmallSquares && squares < kLargeSquares ? std::sqrt(squares) : x.stableNorm();
}

/// Reflections [e_j; y_j] of the panel's columns, which take the place of the rows; their factors tau.
Eigen::VectorXd reflect_panel(Matrix triangle, Matrix rows) {
  const Eigen::Index n = rows.cols();
  Eigen::VectorXd tau = Eigen::VectorXd::Zero(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double length = norm(rows.col(j));
    if (length == 0.0) continue;  // nothing to reflect
    const double head = triangle(j, j), beta = -std::copysign(std::hypot(head, length), head);
    tau[j] = (beta - head) / beta;
    rows.col(j) /= head - beta;
    triangle(j, j) = beta;
    const Eigen::Index rest = n - j - 1;
    if (rest == 0) continue;
    Eigen::VectorXd part = transposed_times(rows.rightCols(rest), rows.col(j));
    part = tau[j] * (part + triangle.row(j).tail(rest).transpose());
    triangle.row(j).tail(rest) -= part.transpose();
    subtract_outer(rows.rightCols(rest), rows.col(j), part);
  }
  return tau;
}

/// T of I - V T V' for the reflections of a panel. The heads e_j are orthogonal to each other.
Eigen::MatrixXd panel_factor(const Eigen::Ref<const Eigen::MatrixXd>& reflectors, const Eigen::VectorXd& tau) {
  const Eigen::Index n = tau.size();
  const Eigen::MatrixXd gram = transposed_product(reflectors, reflectors);
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    T(j, j) = tau[j];
    T.col(j).head(j) = T.topLeftCorner(j, j).triangularView<Eigen::Upper>() * (-tau[j] * gram.col(j).head(j)).eval();
  }
  return T;
}

void apply_panel(const Eigen::Ref<const Eigen::MatrixXd>& reflectors, const Eigen::MatrixXd& T, Matrix top, Matrix bottom) {
  if (top.cols() == 0) return;
  Eigen::MatrixXd W = top;
  W += transposed_product(reflectors, bottom);
  W = (T.transpose().triangularView<Eigen::Lower>() * W).eval();
  top -= W;
  add_product(bottom, reflectors, W, -1.0);
}

/// The panels' factors, one after the other, where they are wanted.
void factorise(Eigen::MatrixXd& triangle, Matrix rows, std::vector<Eigen::MatrixXd>* panels) {
  const Eigen::Index n = triangle.cols();
  for (Eigen::Index j = 0; j < n; j += kPanel) {
    const Eigen::Index width = std::min(kPanel, n - j), rest = n - j - width;
    Matrix panel = rows.middleCols(j, width);
    const Eigen::VectorXd tau = reflect_panel(triangle.block(j, j, width, width), panel);
    if (rest == 0 && panels == nullptr) break;
    Eigen::MatrixXd T = panel_factor(panel, tau);
    apply_panel(panel, T, triangle.block(j, j + width, width, rest), rows.rightCols(rest));
    if (panels != nullptr) panels->push_back(std::move(T));
  }
  triangle.triangularView<Eigen::StrictlyLower>().setZero();
}

}  // namespace

StackedQr::StackedQr(Eigen::MatrixXd triangle, Eigen::MatrixXd rows)
    : triangle_(std::move(triangle)), reflectors_(std::move(rows)) {
  factorise(triangle_, reflectors_, &panels_);
}

void StackedQr::apply(Eigen::Ref<Eigen::MatrixXd> top, Eigen::Ref<Eigen::MatrixXd> bottom) const {
  Eigen::Index j = 0;
  for (const Eigen::MatrixXd& T : panels_) {
    apply_panel(reflectors_.middleCols(j, T.cols()), T, top.middleRows(j, T.cols()), bottom);
    j += T.cols();
  }
}

void fold_rows(Eigen::MatrixXd& triangle, Eigen::Ref<Eigen::MatrixXd> rows) { factorise(triangle, rows, nullptr); }

}  // namespace bodeflow::numerics
