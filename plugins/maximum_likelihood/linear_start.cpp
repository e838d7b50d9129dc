#include "linear_start.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <optional>

#include "coefficients.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

constexpr double kRounding = 1e-15;  // of the triangular factor's diagonal
constexpr int kInverseIterations = 10;
constexpr int kWithoutGain = 6;  // iterations that may pass without a lower cost

// sqrt(weight) / deviation [A Y - D B U] as a matrix on theta, real and imaginary parts, outputs one after the other.
Eigen::MatrixXd equation_matrix(const Lines& lines, const Bases& bases, const Eigen::VectorXcd& delay,
                                const Eigen::MatrixXd& deviation) {
  const Eigen::Index size = lines.size(), outputs = deviation.cols();
  Eigen::MatrixXcd m = Eigen::MatrixXcd::Zero(size * outputs, bases.size());
  for (Eigen::Index i = 0; i < outputs; ++i) {
    const Channel& c = lines.channels[static_cast<std::size_t>(i)];
    const Basis& numerator = bases.numerators[static_cast<std::size_t>(i)];
    const Eigen::VectorXd by = lines.weight.cwiseSqrt().cwiseQuotient(deviation.col(i));
    const Eigen::VectorXcd y = by.cwiseProduct(c.output), u = -by.cwiseProduct(c.input).cwiseProduct(delay);
    m.block(i * size, 0, size, bases.denominator.size()) = y.asDiagonal() * bases.denominator.values();
    m.block(i * size, bases.offset(static_cast<std::size_t>(i)), size, numerator.size()) = u.asDiagonal() * numerator.values();
  }
  return stacked(m);
}

// What the noise adds to |M theta|^2: theta^T C theta.
Eigen::MatrixXd noise_matrix(const Lines& lines, const Bases& bases, const Eigen::VectorXcd& delay,
                             const Eigen::MatrixXd& deviation) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(bases.size(), bases.size());
  const Eigen::Index poles = bases.denominator.size();
  const Eigen::MatrixXcd& a = bases.denominator.values();
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    const Channel& c = lines.channels[i];
    const Eigen::VectorXd by = lines.weight.cwiseQuotient(deviation.col(static_cast<Eigen::Index>(i)).cwiseAbs2());
    const Eigen::MatrixXcd b = delay.asDiagonal() * bases.numerators[i].values();
    const Eigen::VectorXd y = by.cwiseProduct(c.output_variance), u = by.cwiseProduct(c.input_variance);
    const Eigen::VectorXcd yu = by.cwiseProduct(c.covariance);
    const Eigen::Index at = bases.offset(i), size = b.cols();
    sum.topLeftCorner(poles, poles) += (a.adjoint() * y.asDiagonal() * a).real();
    sum.block(at, at, size, size) += (b.adjoint() * u.asDiagonal() * b).real();
    const Eigen::MatrixXd cross = (b.adjoint() * yu.asDiagonal() * a).real();
    sum.block(at, 0, size, poles) -= cross;
    sum.block(0, at, poles, size) -= cross.transpose();
  }
  return sum;
}

// The direction of least |M x|: inverse iteration on the triangular factor, which for a start need not converge to the last
// digit.
Eigen::VectorXd smallest_direction(const Eigen::MatrixXd& m) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(m);
  const Eigen::Index size = m.cols();
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(size, size);
  r.topRows(std::min(m.rows(), size)) = qr.matrixQR().topRows(std::min(m.rows(), size)).triangularView<Eigen::Upper>();
  const double least = kRounding * r.diagonal().cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < size; ++i) {
    if (std::abs(r(i, i)) < least) r(i, i) = least;
  }
  Eigen::VectorXd x = Eigen::VectorXd::Ones(size);
  for (int n = 0; n < kInverseIterations; ++n) {
    r.transpose().triangularView<Eigen::Lower>().solveInPlace(x);
    x.normalize();
    r.triangularView<Eigen::Upper>().solveInPlace(x);
    x.normalize();
  }
  return x;
}

// The direction of least |M x|^2 / x^T C x; empty where M has lost a direction to rounding.
Eigen::VectorXd smallest_ratio(const Eigen::MatrixXd& m, const Eigen::MatrixXd& c) {
  const Eigen::MatrixXd square = m.transpose() * m;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(c, square);
  if (solver.info() != Eigen::Success) return {};
  return solver.eigenvectors().col(m.cols() - 1);
}

Eigen::MatrixXd first_deviation(const Lines& lines, const Structure& structure, const LinearMethod& method) {
  Eigen::MatrixXd d(lines.size(), static_cast<Eigen::Index>(lines.channels.size()));
  for (std::size_t i = 0; i < lines.channels.size(); ++i) {
    const Channel& c = lines.channels[i];
    for (Eigen::Index k = 0; k < lines.size(); ++k) {
      const Complex g = c.output[k] / c.input[k];
      const double variance =
          c.output_variance[k] + std::norm(g) * c.input_variance[k] - 2.0 * std::real(std::conj(g) * c.covariance[k]);
      const double roll_off =
          method.rolled_off ? std::pow(std::abs(1.0 + lines.points[k]), static_cast<double>(structure.free_poles())) : 1.0;
      d(k, static_cast<Eigen::Index>(i)) = roll_off * std::sqrt(variance);
    }
  }
  return d;
}

}  // namespace

const std::vector<LinearMethod>& linear_methods() {
  static const std::vector<LinearMethod> methods = {{false, 1.0, false}, {true, 1.0, true},  {true, 1.0, false},
                                                    {false, 0.5, false}, {false, 1.0, true}, {true, 0.5, true}};
  return methods;
}

Expected<Estimate> linear_start(const Lines& lines, const Structure& structure, double delay_s, const LinearMethod& method,
                                int iterations) {
  const Eigen::VectorXcd delay = delay_factor(lines, delay_s);
  Eigen::MatrixXd deviation = first_deviation(lines, structure, method);
  std::optional<Estimate> best;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0, gained = 0; n < iterations && n - gained < kWithoutGain; ++n) {
    auto bases = bases_for(lines, structure, deviation);
    if (!bases) {
      if (best) break;
      return refusal_in(bases);
    }
    const auto free = free_directions(*bases, structure, lines.scale);
    if (!free) return refusal_in(free);
    const Eigen::MatrixXd m = equation_matrix(lines, *bases, delay, deviation) * *free;
    Eigen::VectorXd phi;
    if (method.total) phi = smallest_ratio(m, free->transpose() * noise_matrix(lines, *bases, delay, deviation) * *free);
    if (phi.size() == 0) phi = smallest_direction(m);
    Estimate next{std::move(*bases), *free * phi, delay_s};
    const Eigen::MatrixXd variance = spread(lines, next);
    const double found = cost(lines, next);
    if (!(variance.minCoeff() > 0.0) || !std::isfinite(found)) break;
    if (found < least) {
      least = found;
      best = next;
      gained = n;
    }
    deviation = variance.array().pow(0.5 * method.relaxation);
    deviation /= deviation.maxCoeff();
  }
  if (!best) return refused("the linear least squares for a start gave no finite model");
  return *best;
}

}  // namespace bodeflow::maximum_likelihood
