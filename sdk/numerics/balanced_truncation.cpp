#include "bodeflow/numerics/balanced_truncation.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <string>

#include "bodeflow/numerics/balance.hpp"
#include "bodeflow/numerics/bilinear.hpp"

namespace bodeflow::numerics {
namespace {

using Complex = std::complex<double>;

struct Schur {
  Eigen::MatrixXcd T, U;  // A = U T U*, T upper triangular
};

// By way of the real form: it takes half the work, and its 2 x 2 blocks are split at once.
Expected<Schur> schur_of(const Eigen::MatrixXd& A) {
  const Eigen::RealSchur<Eigen::MatrixXd> real(A);
  if (real.info() != Eigen::Success) return refused("the Schur form of A was not found");
  Eigen::ComplexSchur<Eigen::MatrixXcd> complex;
  complex.computeFromHessenberg(real.matrixT().cast<Complex>(), real.matrixU().cast<Complex>(), true);
  if (complex.info() != Eigen::Success) return refused("the Schur form of A was not found");
  return Schur{complex.matrixT(), complex.matrixU()};
}

// U upper triangular with T U U* + U U* T* + B B* = 0, from the last row up: of T = [T1 a; 0 l], B = [B1; b], U = [U1 u; 0 t]
//   t = |b| / sqrt(-2 re l),  (T1 + conj(l) I) u = -a t - B1 b* / t,  and U1 belongs to T1 and B1 - u b / t.
Eigen::MatrixXcd triangular_factor(const Eigen::MatrixXcd& T, Eigen::MatrixXcd B) {
  const Eigen::Index n = T.rows();
  Eigen::MatrixXcd U = Eigen::MatrixXcd::Zero(n, n);
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    const Complex l = T(k, k);
    const double t = B.row(k).norm() / std::sqrt(-2.0 * l.real());
    U(k, k) = t;
    if (!(t > 0.0) || k == 0) continue;
    Eigen::MatrixXcd shifted = T.topLeftCorner(k, k);
    shifted.diagonal().array() += std::conj(l);
    Eigen::VectorXcd u = -t * T.col(k).head(k) - B.topRows(k) * (B.row(k).adjoint() / t);
    shifted.triangularView<Eigen::Upper>().solveInPlace(u);
    U.col(k).head(k) = u;
    B.topRows(k) -= u * (B.row(k) / t);
  }
  return U;
}

struct Factors {
  Eigen::MatrixXd controllability, observability;
};

Expected<Factors> factors_of(const StateSpace& system) {
  auto P = gramian_factor(system.A, system.B);
  if (!P) return tl::make_unexpected(P.error());
  auto Q = gramian_factor(system.A.transpose(), system.C.transpose());
  if (!Q) return tl::make_unexpected(Q.error());
  return Factors{std::move(*P), std::move(*Q)};
}

// Continuous in time, with A balanced by powers of two.
Expected<StateSpace> prepared(const StateSpace& system) {
  StateSpace s = system;
  if (system.sample_time != 0.0) {
    const auto mapped = undo_bilinear(system, 2.0 / system.sample_time);
    if (!mapped) return tl::make_unexpected(mapped.error());
    s = *mapped;
  }
  const Eigen::VectorXd scales = balancing_scales(s.A);
  s.A = scaled_by(s.A, scales);
  s.B = scales.cwiseInverse().asDiagonal() * s.B;
  s.C = s.C * scales.asDiagonal();
  return s;
}

}  // namespace

Expected<Eigen::MatrixXd> gramian_factor(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  if (A.rows() != A.cols() || B.rows() != A.rows()) return refused("A must be square, and B as high");
  if (!A.allFinite() || !B.allFinite()) return refused("an entry of A or B is not a finite number");
  const Eigen::Index n = A.rows();
  if (n == 0) return Eigen::MatrixXd(0, 0);
  const auto schur = schur_of(A);
  if (!schur) return tl::make_unexpected(schur.error());
  const double rightmost = schur->T.diagonal().real().maxCoeff();
  if (!(rightmost < 0.0)) return refused("the system is not stable: it has no Gramian");
  const Eigen::MatrixXcd F = schur->U * triangular_factor(schur->T, schur->U.adjoint() * B.cast<Complex>());
  Eigen::MatrixXd wide(n, 2 * n);
  wide << F.real(), F.imag();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(wide.transpose());
  const Eigen::MatrixXd R = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  return Eigen::MatrixXd(R.transpose());
}

Expected<Eigen::VectorXd> hankel_singular_values(const StateSpace& system) {
  const auto s = prepared(system);
  if (!s) return tl::make_unexpected(s.error());
  if (s->states() == 0) return Eigen::VectorXd();
  const auto factors = factors_of(*s);
  if (!factors) return tl::make_unexpected(factors.error());
  return Eigen::VectorXd(
      Eigen::BDCSVD<Eigen::MatrixXd>(factors->observability.transpose() * factors->controllability).singularValues());
}

Expected<Reduced> balanced_truncation(const StateSpace& system, Eigen::Index states) {
  if (states < 0 || states > system.states())
    return refused(std::to_string(states) + " states; allowed: 0 to " + std::to_string(system.states()));
  const auto s = prepared(system);
  if (!s) return tl::make_unexpected(s.error());
  const Eigen::Index n = s->states();
  if (n == 0) return Reduced{system, {}, 0.0};
  const auto factors = factors_of(*s);
  if (!factors) return tl::make_unexpected(factors.error());
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(factors->observability.transpose() * factors->controllability,
                                           Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& sigma = svd.singularValues();
  const double floor = std::numeric_limits<double>::epsilon() * sigma[0];
  if (states > 0 && !(sigma[states - 1] > floor))
    return refused("only " + std::to_string((sigma.array() > floor).count()) + " Hankel singular values are above rounding, " +
                   std::to_string(states) + " states were asked for");
  const Eigen::VectorXd scale = sigma.head(states).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd right = factors->controllability * svd.matrixV().leftCols(states) * scale.asDiagonal();
  const Eigen::MatrixXd left =
      scale.asDiagonal() * svd.matrixU().leftCols(states).transpose() * factors->observability.transpose();
  Reduced reduced{{left * s->A * right, left * s->B, s->C * right, s->D, 0.0}, sigma, 2.0 * sigma.tail(n - states).sum()};
  if (system.sample_time != 0.0) {
    const auto back = bilinear(reduced.system, 2.0 / system.sample_time, system.sample_time);
    if (!back) return tl::make_unexpected(back.error());
    reduced.system = *back;
  }
  return reduced;
}

}  // namespace bodeflow::numerics
