#include "maximum_likelihood.hpp"

#include <Eigen/Cholesky>
#include <bodeflow/numerics/levenberg_marquardt.hpp>
#include <cmath>
#include <complex>

#include "powers.hpp"

namespace bodeflow::koopmans_levin {

namespace {

using Complex = std::complex<double>;

// Parameters a_1 .. a_n, b_0 .. b_n, tau_0 .. tau_(n-1).
Eigen::VectorXd packed(const Model& m) {
  Eigen::VectorXd p(3 * m.order() + 1);
  p << m.a.tail(m.order()), m.b, m.tau;
  return p;
}

Model unpacked(const Eigen::VectorXd& p, const Model& like) {
  const Eigen::Index n = like.order();
  Model m = like;
  m.a.tail(n) = p.head(n);
  m.b = p.segment(n, n + 1);
  m.tau = p.tail(n);
  return m;
}

// The equation at one line and its derivatives by the parameters: error is linear in them, spread D = ratio |A|^2 + |B|^2
// quadratic.
struct Equation {
  Complex error;
  Eigen::VectorXcd error_slope;
  double spread = 0.0;
  Eigen::VectorXd spread_slope;
  Eigen::VectorXcd powers;  // 1, z .. z^n
};

void equation_at(const Lines& lines, Eigen::Index k, const Model& m, Equation& e) {
  const Eigen::Index n = m.order();
  const Complex z = std::polar(1.0, -lines.omega(k));
  e.powers.resize(n + 1);
  e.powers[0] = 1.0;
  for (Eigen::Index i = 1; i <= n; ++i) e.powers[i] = e.powers[i - 1] * z;
  const Complex A = ascending(m.a, z), B = ascending(m.b, z), T = ascending(m.tau, z);
  e.error = A * lines.output[k] - B * lines.input[k] - T;
  e.spread = m.ratio * std::norm(A) + std::norm(B);
  e.error_slope.resize(3 * n + 1);
  e.error_slope << lines.output[k] * e.powers.tail(n), -lines.input[k] * e.powers, -e.powers.head(n);
  e.spread_slope.setZero(3 * n + 1);
  e.spread_slope.head(n) = 2.0 * m.ratio * (std::conj(A) * e.powers.tail(n)).real();
  e.spread_slope.segment(n, n + 1) = 2.0 * (std::conj(B) * e.powers).real();
}

numerics::LeastSquaresProblem problem_of(const Lines& lines, const Model& like) {
  const Eigen::Index size = lines.size();
  numerics::LeastSquaresProblem problem;
  problem.residuals = 2 * size;
  problem.residual = [&lines, &like, size](const Eigen::VectorXd& p, Eigen::VectorXd& r) {
    const Model m = unpacked(p, like);
    Equation e;
    for (Eigen::Index k = 0; k < size; ++k) {
      equation_at(lines, k, m, e);
      const Complex value = e.error * std::sqrt(lines.weight[k] / e.spread);
      r[k] = value.real();
      r[size + k] = value.imag();
    }
  };
  problem.jacobian = [&lines, &like, size](const Eigen::VectorXd& p, Eigen::MatrixXd& j) {
    const Model m = unpacked(p, like);
    Equation e;
    for (Eigen::Index k = 0; k < size; ++k) {
      equation_at(lines, k, m, e);
      const Eigen::VectorXcd slope =
          std::sqrt(lines.weight[k] / e.spread) * (e.error_slope - (0.5 * e.error / e.spread) * e.spread_slope.cast<Complex>());
      j.row(k) = slope.real().transpose();
      j.row(size + k) = slope.imag().transpose();
    }
  };
  return problem;
}

// Gradient of |error|^2 / spread at one line and its Hessian.
void add_curvature(const Equation& e, double ratio, double weight, Eigen::MatrixXd& hessian, Eigen::MatrixXd& squares) {
  const Eigen::Index n = e.powers.size() - 1, size = e.spread_slope.size();
  const double power = std::norm(e.error), d = e.spread;
  const Eigen::VectorXd power_slope = 2.0 * (std::conj(e.error) * e.error_slope).real();
  const Eigen::VectorXd gradient = (power_slope - (power / d) * e.spread_slope) / d;
  squares.noalias() += weight * weight * gradient * gradient.transpose();
  Eigen::MatrixXd spread_curvature = Eigen::MatrixXd::Zero(size, size);
  const Eigen::VectorXcd tail = e.powers.tail(n);
  spread_curvature.topLeftCorner(n, n) = 2.0 * ratio * (tail.conjugate() * tail.transpose()).real();
  spread_curvature.block(n, n, n + 1, n + 1) = 2.0 * (e.powers.conjugate() * e.powers.transpose()).real();
  const Eigen::MatrixXd mixed = power_slope * e.spread_slope.transpose();
  hessian +=
      weight * (2.0 * (e.error_slope.conjugate() * e.error_slope.transpose()).real() / d - (mixed + mixed.transpose()) / (d * d) -
                power / (d * d) * spread_curvature + 2.0 * power / (d * d * d) * e.spread_slope * e.spread_slope.transpose());
}

}  // namespace

Expected<RefinedModel> maximum_likelihood(const Lines& lines, const Model& start) {
  const Eigen::Index n = start.order();
  if (start.tau.size() != n) return refused("the start needs a transient polynomial");
  const auto fit = numerics::levenberg_marquardt(problem_of(lines, start), packed(start));
  if (!fit) return tl::make_unexpected(fit.error());
  RefinedModel refined;
  refined.model = unpacked(fit->parameters, start);
  refined.cost = fit->cost;
  refined.converged = fit->converged;
  refined.reason = fit->reason;
  refined.model.noise = fit->cost / lines.total_weight();
  const double equations = static_cast<double>(lines.equations());
  refined.model.noise_unbiased = refined.model.noise / (1.0 - static_cast<double>(3 * n + 1) / equations);
  const Eigen::Index size = 3 * n + 1;
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size), squares = hessian;
  Equation e;
  for (Eigen::Index k = 0; k < lines.size(); ++k) {
    equation_at(lines, k, refined.model, e);
    add_curvature(e, start.ratio, lines.weight[k], hessian, squares);
  }
  const Eigen::VectorXd scale = hessian.diagonal().cwiseAbs().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> cholesky(scale.asDiagonal() * hessian * scale.asDiagonal());
  if (cholesky.info() != Eigen::Success)
    return refused("the likelihood has no maximum of full curvature at the end of the search");
  const Eigen::MatrixXd inverse = scale.asDiagonal() * cholesky.solve(Eigen::MatrixXd(scale.asDiagonal()));
  refined.covariance = (inverse * squares * inverse).topLeftCorner(2 * n + 1, 2 * n + 1);
  return refined;
}

}  // namespace bodeflow::koopmans_levin
