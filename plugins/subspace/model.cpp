#include "model.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <bodeflow/numerics/bilinear.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "row_triangle.hpp"
#include "stability.hpp"

namespace bodeflow::subspace {
namespace {

using Complex = std::complex<double>;
using RowMajorC = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Eigen::Index kBlock = 2000;  // lines that are worked through at once

/// Rows C q_j(A) A for j = 0 .. q - 2, from those of C q_j(A): (h' kron I) U.
Eigen::MatrixXd shifted(const Eigen::MatrixXd& h, const Eigen::MatrixXd& U, Eigen::Index outputs) {
  const Eigen::Index q = h.rows();
  Eigen::MatrixXd S((q - 1) * outputs, U.cols());
  for (Eigen::Index o = 0; o < outputs; ++o) {
    const Eigen::MatrixXd rows = U(Eigen::seqN(o, q, outputs), Eigen::all);
    S(Eigen::seqN(o, q - 1, outputs), Eigen::all) = h.transpose() * rows;
  }
  return S;
}

/// C (z I - A)^-1 at a line for a Hessenberg A: rows times columns, eliminated from the last column on.
class Resolvent {
 public:
  Resolvent(const Eigen::MatrixXd& hessenberg, const Eigen::MatrixXd& C)
      : transposed_(hessenberg.transpose().cast<Complex>()), C_(C.transpose().cast<Complex>()) {}

  /// states x outputs: (z I - A)^-T C'.
  Eigen::MatrixXcd at(Complex z) {
    // The transpose is lower Hessenberg; reversed, upper Hessenberg.
    const Eigen::Index n = transposed_.rows();
    work_ = -transposed_.reverse();
    work_.diagonal().array() += z;
    Eigen::MatrixXcd X = C_.colwise().reverse();
    for (Eigen::Index k = 0; k + 1 < n; ++k) {
      if (std::abs(work_(k + 1, k)) > std::abs(work_(k, k))) {
        work_.row(k).tail(n - k).swap(work_.row(k + 1).tail(n - k));
        X.row(k).swap(X.row(k + 1));
      }
      if (work_(k + 1, k) == 0.0) continue;
      const Complex factor = work_(k + 1, k) / work_(k, k);
      work_.row(k + 1).tail(n - k - 1) -= factor * work_.row(k).tail(n - k - 1);
      X.row(k + 1) -= factor * X.row(k);
    }
    work_.triangularView<Eigen::Upper>().solveInPlace(X);
    return X.colwise().reverse();
  }

 private:
  RowMajorC transposed_, work_;
  Eigen::MatrixXcd C_;
};

/// Rows [C (z I - A)^-1, I] of some lines, stacked: real parts of all lines and outputs above imaginary ones.
Eigen::MatrixXd regressors(Resolvent& resolvent, const Eigen::VectorXcd& z, Eigen::Index states, Eigen::Index outputs) {
  const Eigen::Index rows = z.size() * outputs;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(2 * rows, states + outputs);
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    const Eigen::MatrixXcd X = resolvent.at(z[k]);
    F.block(k * outputs, 0, outputs, states) = X.transpose().real();
    F.block(rows + k * outputs, 0, outputs, states) = X.transpose().imag();
    F.block(k * outputs, states, outputs, outputs).setIdentity();
  }
  return F;
}

/// The data of those rows, one column an input.
Eigen::MatrixXd targets(const Lines& lines, Eigen::Index first, Eigen::Index size) {
  const Eigen::Index p = lines.outputs, rows = size * p;
  Eigen::MatrixXd Y(2 * rows, lines.inputs());
  for (Eigen::Index k = 0; k < size; ++k) {
    const Eigen::MatrixXcd G = lines.at(first + k);
    Y.middleRows(k * p, p) = G.real();
    Y.middleRows(rows + k * p, p) = G.imag();
  }
  return Y;
}

Eigen::VectorXd row_weights(const Lines& lines, Eigen::Index first, Eigen::Index size) {
  Eigen::VectorXd w(2 * size * lines.outputs);
  for (Eigen::Index k = 0; k < size; ++k) {
    w.segment(k * lines.outputs, lines.outputs).setConstant(lines.weight[first + k]);
    w.segment((size + k) * lines.outputs, lines.outputs).setConstant(lines.weight[first + k]);
  }
  return w;
}

/// Step 9: B and D, and with them the response at the lines. `system` has A in Hessenberg form, and C.
void fit_inputs(const Lines& lines, const Eigen::VectorXcd& z, numerics::StateSpace& system, Eigen::MatrixXcd& response) {
  const Eigen::Index n = system.A.rows(), p = lines.outputs, unknowns = n + p;
  Resolvent resolvent(system.A, system.C);
  RowTriangle triangle(unknowns + lines.inputs());
  const bool keep = lines.size() <= kBlock;
  Eigen::MatrixXd kept;
  for (Eigen::Index k = 0; k < lines.size(); k += kBlock) {
    const Eigen::Index size = std::min(kBlock, lines.size() - k);
    Eigen::MatrixXd F = regressors(resolvent, z.segment(k, size), n, p), rows(F.rows(), unknowns + lines.inputs());
    const Eigen::VectorXd w = row_weights(lines, k, size);
    rows.leftCols(unknowns) = w.asDiagonal() * F;
    rows.rightCols(lines.inputs()) = w.asDiagonal() * targets(lines, k, size);
    triangle.add(std::move(rows));
    if (keep) kept = std::move(F);
  }
  Eigen::MatrixXd R = triangle.R().leftCols(unknowns).topRows(unknowns);
  const Eigen::VectorXd norm = R.colwise().norm().unaryExpr([](double x) { return x > 0.0 ? x : 1.0; });
  R = R * norm.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd solved = R.colPivHouseholderQr().solve(triangle.R().topRightCorner(unknowns, lines.inputs()));
  const Eigen::MatrixXd X = norm.cwiseInverse().asDiagonal() * solved;
  system.B = X.topRows(n);
  system.D = X.bottomRows(p);
  response.resize(lines.size(), lines.response.cols());
  for (Eigen::Index k = 0; k < lines.size(); k += kBlock) {
    const Eigen::Index size = std::min(kBlock, lines.size() - k);
    if (!keep) kept = regressors(resolvent, z.segment(k, size), n, p);
    const Eigen::MatrixXd G = kept * X;
    for (Eigen::Index l = 0; l < size; ++l)
      for (Eigen::Index i = 0; i < lines.inputs(); ++i)
        for (Eigen::Index o = 0; o < p; ++o) response(k + l, i * p + o) = Complex(G(l * p + o, i), G((size + l) * p + o, i));
  }
}

Expected<Eigen::MatrixXd> state_matrix(const Range& range, const Eigen::MatrixXd& U, Eigen::Index outputs, Stability stability,
                                       Eigen::Index& moved) {
  const Eigen::Index rows = U.rows() - outputs;
  const Eigen::MatrixXd S = shifted(range.rule.shift, U, outputs);
  Eigen::MatrixXd A = U.topRows(rows).colPivHouseholderQr().solve(S);
  if (stability == Stability::none) return A;
  if (stability == Stability::project) {
    auto projected = stable_projection(A);
    if (!projected) return unexpected(projected.error().text);
    moved = projected->moved;
    return std::move(projected->A);
  }
  const Eigen::Index outside = (A.eigenvalues().cwiseAbs().array() >= 1.0).count();
  if (outside == 0) return A;
  moved = outside;
  return maciejowski_matrix(range, U.cols(), outputs);
}

}  // namespace

Eigen::MatrixXd maciejowski_matrix(const Range& range, Eigen::Index order, Eigen::Index outputs) {
  const Eigen::MatrixXd U = range.vectors.leftCols(order);
  return U.topRows(U.rows() - outputs).transpose() * shifted(range.rule.shift, U, outputs);
}

Eigen::MatrixXcd response_of(const numerics::StateSpace& system, const Eigen::VectorXd& omega_rad_s) {
  const auto G = numerics::hessenberg_response(system, omega_rad_s / (2.0 * std::numbers::pi));
  Eigen::MatrixXcd response(omega_rad_s.size(), system.D.size());
  for (Eigen::Index k = 0; k < response.rows(); ++k) response.row(k) = G[static_cast<std::size_t>(k)].reshaped().transpose();
  return response;
}

Expected<Model> model_of_order(const Lines& lines, const Plane& plane, const Range& range, Eigen::Index order,
                               Stability stability) {
  const Eigen::Index p = lines.outputs, most = std::min(range.vectors.rows() - p, range.singular_values.size());
  if (order < 1 || order > most)
    return unexpected("order " + std::to_string(order) + "; allowed with " + std::to_string(range.rule.shift.rows()) +
                      " basis functions: 1 to " + std::to_string(most));
  if (2 * lines.size() * p < order + p)
    return unexpected(std::to_string(lines.size()) + " lines are too few for order " + std::to_string(order));
  const Eigen::MatrixXd U = range.vectors.leftCols(order);
  Model model;
  const auto A = state_matrix(range, U, p, stability, model.moved);
  if (!A) return unexpected(A.error().text);
  if (!A->allFinite()) return unexpected("the state matrix of order " + std::to_string(order) + " is not finite");
  const Eigen::HessenbergDecomposition<Eigen::MatrixXd> form(*A);
  numerics::StateSpace system;
  system.A = form.matrixH();
  system.C = U.topRows(p) * Eigen::MatrixXd(form.matrixQ()) / range.rule.first;
  fit_inputs(lines, plane.circle(lines.omega_rad_s), system, model.response);
  if (!system.B.allFinite() || !system.D.allFinite() || !model.response.allFinite())
    return unexpected("the model of order " + std::to_string(order) + " is not finite: a pole lies on a line of the response");
  model.circle_poles = system.A.eigenvalues();
  model.unstable = (model.circle_poles.cwiseAbs().array() > 1.0).count();
  model.poles = model.circle_poles.unaryExpr([&](Complex z) { return plane.pole(z); });
  system.sample_time = plane.discrete() ? plane.sample_time_s : 1.0;
  if (plane.discrete()) {
    model.system = std::move(system);
    return model;
  }
  auto continuous = numerics::undo_bilinear(system, plane.prewarp_rad_s);
  if (!continuous) return unexpected(continuous.error().text);
  model.system = std::move(*continuous);
  return model;
}

}  // namespace bodeflow::subspace
