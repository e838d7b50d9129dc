#include "bodeflow/numerics/frequency_response.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <numbers>

#include "bodeflow/numerics/balance.hpp"
#include "bodeflow/numerics/polynomial.hpp"

namespace bodeflow::numerics {

using Complex = std::complex<double>;

Complex frequency_point(double frequency_hz, double sample_time) {
  const double omega = 2 * std::numbers::pi * frequency_hz;
  return sample_time == 0 ? Complex(0, omega) : std::polar(1.0, omega * sample_time);
}

Eigen::VectorXcd frequency_response(const TransferFunction& system, const Eigen::VectorXd& frequency_hz) {
  return frequency_hz.unaryExpr([&](double f) {
    const Complex x = frequency_point(f, system.sample_time);
    return evaluate(system.numerator, x) / evaluate(system.denominator, x);
  });
}

Eigen::VectorXcd frequency_response(const ZeroPoleGain& system, const Eigen::VectorXd& frequency_hz) {
  return frequency_hz.unaryExpr([&](double f) {
    const Complex x = frequency_point(f, system.sample_time);
    Complex value = system.gain;
    // A zero and a pole by turns: the product stays in range where the numerator alone would not.
    for (Eigen::Index k = 0; k < std::max(system.zeros.size(), system.poles.size()); ++k) {
      if (k < system.zeros.size()) value *= x - system.zeros[k];
      if (k < system.poles.size()) value /= x - system.poles[k];
    }
    return value;
  });
}

std::vector<Eigen::MatrixXcd> frequency_response(const StateSpace& system, const Eigen::VectorXd& frequency_hz) {
  const Eigen::VectorXd scales = balancing_scales(system.A);
  const Eigen::MatrixXcd A = scaled_by(system.A, scales).cast<Complex>();
  const Eigen::MatrixXcd B = (scales.cwiseInverse().asDiagonal() * system.B).cast<Complex>();
  const Eigen::MatrixXcd C = (system.C * scales.asDiagonal()).cast<Complex>();
  std::vector<Eigen::MatrixXcd> response;
  response.reserve(static_cast<std::size_t>(frequency_hz.size()));
  for (const double f : frequency_hz) {
    Eigen::MatrixXcd value = system.D.cast<Complex>();
    if (system.states() > 0) {
      Eigen::MatrixXcd resolvent = -A;
      resolvent.diagonal().array() += frequency_point(f, system.sample_time);
      value += C * resolvent.partialPivLu().solve(B);
    }
    response.push_back(std::move(value));
  }
  return response;
}

namespace {

// Solves (x I - H) X = B in place of B for an upper Hessenberg H: elimination with row exchanges of neighbours, O(n^2).
// Rows in memory order, because elimination works along them.
using Rows = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void solve_hessenberg(Complex x, const Rows& H, Rows& work, Eigen::MatrixXcd& B) {
  const Eigen::Index n = H.rows();
  work = -H;
  work.diagonal().array() += x;
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    if (std::abs(work(k + 1, k)) > std::abs(work(k, k))) {
      work.row(k).tail(n - k).swap(work.row(k + 1).tail(n - k));
      B.row(k).swap(B.row(k + 1));
    }
    if (work(k + 1, k) == 0.0) continue;
    const Complex factor = work(k + 1, k) / work(k, k);
    work.row(k + 1).tail(n - k - 1) -= factor * work.row(k).tail(n - k - 1);
    B.row(k + 1) -= factor * B.row(k);
  }
  work.triangularView<Eigen::Upper>().solveInPlace(B);
}

}  // namespace

std::vector<Eigen::MatrixXcd> hessenberg_response(const StateSpace& system, const Eigen::VectorXd& frequency_hz) {
  const Eigen::VectorXd scales = balancing_scales(system.A);
  Eigen::MatrixXd A = scaled_by(system.A, scales), B = scales.cwiseInverse().asDiagonal() * system.B,
                  C = system.C * scales.asDiagonal();
  if (system.states() > 2) {
    const Eigen::HessenbergDecomposition<Eigen::MatrixXd> form(A);
    const Eigen::MatrixXd Q = form.matrixQ();
    A = form.matrixH();
    B = Q.transpose() * B;
    C = C * Q;
  }
  const Rows H = A.cast<Complex>();
  Rows work;
  Eigen::MatrixXcd X;
  std::vector<Eigen::MatrixXcd> response;
  response.reserve(static_cast<std::size_t>(frequency_hz.size()));
  for (const double f : frequency_hz) {
    Eigen::MatrixXcd value = system.D.cast<Complex>();
    if (system.states() > 0) {
      X = B.cast<Complex>();
      solve_hessenberg(frequency_point(f, system.sample_time), H, work, X);
      value += C * X;
    }
    response.push_back(std::move(value));
  }
  return response;
}

}  // namespace bodeflow::numerics
