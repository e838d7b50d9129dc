#include "rational.hpp"

#include <Eigen/LU>
#include <bodeflow/numerics/hessenberg_eigenvalues.hpp>
#include <cmath>
#include <string>

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr double kNoDegree = 1e-250;  // of the leading coefficient beside the greatest: the quotient would overflow
constexpr double kSingular = 1e-15;   // reciprocal condition of I + A_z: an eigenvalue of -1 to rounding

}  // namespace

Expected<Eigen::MatrixXd> colleague_matrix(const Eigen::MatrixXd& h, const Eigen::VectorXd& c) {
  const Eigen::Index M = h.cols();
  Eigen::MatrixXd K = h.topRows(M);
  if (M == 0) return K;
  if (!(std::abs(c[M]) > kNoDegree * c.cwiseAbs().maxCoeff()))
    return unexpected("the denominator has no degree " + std::to_string(M) + ": lower the order");
  K.col(M - 1) -= h(M, M - 1) / c[M] * c.head(M);
  return K;
}

Expected<Eigen::VectorXcd> roots_of(const Eigen::MatrixXd& h, const Eigen::VectorXd& c) {
  const auto K = colleague_matrix(h, c);
  if (!K) return unexpected(K.error().text);
  if (K->rows() == 0) return Eigen::VectorXcd();
  auto found = numerics::hessenberg_eigenvalues(*K);  // the last column alone is not that of h
  if (!found) return unexpected("the poles were not found: " + found.error().text);
  return std::move(*found);
}

Expected<numerics::StateSpace> state_space(const Rational& model) {
  const Eigen::Index M = model.order();
  const auto K = colleague_matrix(model.hessenberg, model.denominator);
  if (!K) return unexpected(K.error().text);
  const Eigen::MatrixXd D = M == 0 ? Eigen::MatrixXd(model.numerators.row(0).transpose() / model.denominator[0])
                                   : Eigen::MatrixXd(model.numerators.row(M).transpose() / model.denominator[M]);
  if (M == 0) return numerics::StateSpace{{}, Eigen::MatrixXd(0, 1), Eigen::MatrixXd(D.rows(), 0), D, model.plane.sample_time_s};
  const Eigen::MatrixXd A = K->transpose();
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(M, 1);
  B(M - 1, 0) = model.hessenberg(M, M - 1) / model.denominator[M];
  const Eigen::MatrixXd C = model.numerators.topRows(M).transpose() - D * model.denominator.head(M).transpose();
  if (model.plane.discrete()) return numerics::StateSpace{A, B, C, D, model.plane.sample_time_s};
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(M, M);
  const Eigen::PartialPivLU<Eigen::MatrixXd> sum(I + A);
  if (!(sum.rcond() > kSingular)) return unexpected("a pole lies at infinity: lower the order, or change the pre-warp frequency");
  const Eigen::MatrixXd sum_transposed = (I + A).transpose();
  const double root = std::sqrt(2.0 * model.plane.prewarp_rad_s);
  const Eigen::MatrixXd held = sum.solve(B);
  const Eigen::MatrixXd seen = Eigen::PartialPivLU<Eigen::MatrixXd>(sum_transposed).solve(C.transpose()).transpose();
  return numerics::StateSpace{model.plane.prewarp_rad_s * sum.solve(A - I), root * held, root * seen, D - C * held, 0.0};
}

numerics::StateSpace reshaped(const numerics::StateSpace& one, Eigen::Index inputs) {
  const Eigen::Index M = one.states(), outputs = one.outputs() / inputs;
  numerics::StateSpace s;
  s.sample_time = one.sample_time;
  s.D = one.D.reshaped(outputs, inputs);
  const bool by_input = inputs <= outputs;
  const Eigen::Index copies = by_input ? inputs : outputs;
  s.A = Eigen::MatrixXd::Zero(copies * M, copies * M);
  s.B = Eigen::MatrixXd::Zero(copies * M, inputs);
  s.C = Eigen::MatrixXd::Zero(outputs, copies * M);
  for (Eigen::Index c = 0; c < copies; ++c) {
    if (by_input) {
      s.A.block(c * M, c * M, M, M) = one.A;
      s.B.block(c * M, c, M, 1) = one.B;
      s.C.middleCols(c * M, M) = one.C.middleRows(c * outputs, outputs);
      continue;
    }
    s.A.block(c * M, c * M, M, M) = one.A.transpose();
    s.C.block(c, c * M, 1, M) = one.B.transpose();
    for (Eigen::Index j = 0; j < inputs; ++j) s.B.block(c * M, j, M, 1) = one.C.row(j * outputs + c).transpose();
  }
  return s;
}

Expected<numerics::StateSpace> state_space(const Rational& model, Eigen::Index inputs) {
  if (inputs < 1 || model.channels() % inputs != 0)
    return unexpected(std::to_string(model.channels()) + " responses are no whole number of columns for " +
                      std::to_string(inputs) + " inputs");
  auto one = state_space(model);
  if (!one) return one;
  return reshaped(*one, inputs);
}

}  // namespace bodeflow::sanathanan_koerner
