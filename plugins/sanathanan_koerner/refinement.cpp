#include "refinement.hpp"

#include <Eigen/QR>
#include <cmath>

#include "elimination.hpp"
#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr double kFirstDamping = 1e-6;  // of the squared norm of the equations
constexpr double kMostDamping = 1e6;
constexpr double kRounding = 1e-13;  // error at which exact data are reproduced
constexpr double kFarthest = 1e6;    // times the highest frequency: a pole further out is no part of a proper model in doubles

/// Triangle of the equations of a step, the residual as last column, in the basis of the model.
Eigen::MatrixXd step_equations(const Data& data, const Eigen::VectorXd& q, const Basis& basis, const Fit& now) {
  const Elimination elimination(data, q, basis.vectors, true);
  const Eigen::VectorXcd turn = now.denominator.cwiseQuotient(now.denominator.cwiseAbs().cast<std::complex<double>>());
  Eigen::MatrixXcd factors(data.lines(), data.channels());
  Eigen::MatrixXd left(2 * data.lines(), data.channels());
  for (Eigen::Index i = 0; i < data.channels(); ++i) {
    const Eigen::VectorXd ratio = elimination.ratio(i);
    factors.col(i) = ratio.cwiseProduct(now.response.col(i));
    const Eigen::VectorXcd residual = data.response.col(i) - now.response.col(i);
    left.col(i) = stacked(ratio.cwiseProduct(q).cwiseProduct(turn).cwiseProduct(residual));
  }
  return condensed(elimination, factors, basis.vectors, left);
}

/// min |R delta + r|^2 + damping |delta|^2, delta orthogonal to the denominator, whose scale is free.
Eigen::VectorXd step(const Eigen::MatrixXd& triangle, const Eigen::VectorXd& denominator, double damping) {
  const Eigen::Index n = denominator.size();
  const double size = triangle.topLeftCorner(n, n).norm();
  Eigen::MatrixXd rows(2 * n + 1, n);
  rows << triangle.topLeftCorner(n, n), std::sqrt(damping / static_cast<double>(n)) * size * Eigen::MatrixXd::Identity(n, n),
      size * denominator.normalized().transpose();
  Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * n + 1);
  right.head(n) = -triangle.col(n).head(n);
  return rows.colPivHouseholderQr().solve(right);
}

/// True without poles on their way to infinity, which a state space can't hold: its direct part cancels theirs.
bool is_proper(const Fit& f, const Eigen::VectorXd& omega) {
  return f.model.plane.discrete() || (f.poles.array().abs() <= kFarthest * omega[omega.size() - 1]).all();
}

bool is_stable(const Fit& f) {
  if (f.model.plane.discrete()) return (f.poles.array().abs() <= 1.0).all();
  return (f.poles.array().real() <= 0.0).all();
}

}  // namespace

Expected<Fit> refined(const Data& data, const Fit& start, const RefinementSettings& settings) {
  const Eigen::Index order = start.model.order();
  const Plane plane = start.model.plane;
  const Eigen::VectorXcd z = plane.circle(data.omega_rad_s);
  const Eigen::VectorXd q = shared_weights(data);
  auto now = with_denominator(data, plane, start.denominator, order);
  if (!now) return now;
  Course course = now->course;
  const auto ended = [&](bool converged, std::string reason) {
    course.converged = converged;
    course.reason = std::move(reason);
    now->course = course;
    return std::move(now);
  };
  double damping = kFirstDamping;
  for (int count = 0; count < settings.steps; ++count) {
    const double error = now->error();
    if (error < kRounding || order == 0) return ended(true, "the error is at the level of rounding");
    const Eigen::VectorXd w = q.array() / now->denominator.array().abs();
    const auto basis = arnoldi(z, w, order);
    if (!basis) return ended(false, basis.error().text);
    const Eigen::VectorXd c = now->model.denominator;
    const Eigen::MatrixXd triangle = step_equations(data, q, *basis, *now);
    if (!triangle.allFinite()) return ended(false, "the equations of a step are not finite");
    bool accepted = false;
    for (; damping <= kMostDamping && !accepted; damping *= accepted ? 0.1 : 10.0) {
      const Eigen::VectorXcd values = unstacked(basis->vectors * (c + step(triangle, c, damping)));
      Eigen::VectorXcd d(values.size());
      for (Eigen::Index k = 0; k < d.size(); ++k) d[k] = w[k] > 0.0 ? values[k] / w[k] : std::complex<double>(1.0);
      auto trial = with_denominator(data, plane, d, order);
      if (!trial || !is_proper(*trial, data.omega_rad_s) || (settings.stable && !is_stable(*trial))) continue;
      if (!(trial->error() < error)) continue;
      accepted = true;
      now = std::move(trial);
      note(course, now->error());
    }
    if (!accepted) return ended(true, "no step lowers the error");
    const double fall = 1.0 - std::pow(now->error() / error, 2);
    if (fall < settings.tolerance) return ended(true, "the error falls no more");
  }
  return ended(false, "the limit of " + std::to_string(settings.steps) + " steps");
}

}  // namespace bodeflow::sanathanan_koerner
