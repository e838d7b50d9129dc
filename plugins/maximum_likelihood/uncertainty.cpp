#include "uncertainty.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "coefficients.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

constexpr double kLeastSingularValue = 1e-10;  // of columns of unit length: below, rounding decides the covariance

// From theta and delay to the directions that are free.
Eigen::MatrixXd free_columns(const Eigen::MatrixXd& directions, bool delay) {
  const Eigen::Index extra = delay ? 1 : 0;
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(directions.rows() + 1, directions.cols() + extra);
  columns.topLeftCorner(directions.rows(), directions.cols()) = directions;
  if (delay) columns(directions.rows(), directions.cols()) = 1.0;
  return columns;
}

// sum over the outputs of J_k^T r_k, a column a line.
Eigen::MatrixXd gradients(const Eigen::MatrixXcd& j, const Eigen::MatrixXcd& r) {
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(j.cols(), r.rows());
  for (Eigen::Index i = 0; i < r.cols(); ++i) {
    for (Eigen::Index k = 0; k < r.rows(); ++k) g.col(k) += (j.row(i * r.rows() + k).adjoint() * r(k, i)).real();
  }
  return g;
}

// d(root)/dc = -q(root) / (derivative of the polynomial there), the derivative from the other roots.
Eigen::RowVectorXcd slope_of_root(const Basis& basis, const Eigen::VectorXd& c, const Eigen::VectorXcd& roots,
                                  Eigen::Index which) {
  Complex derivative = basis.monomials()(roots.size(), roots.size()) * c[roots.size()];
  for (Eigen::Index i = 0; i < roots.size(); ++i) {
    if (i != which) derivative *= roots[which] - roots[i];
  }
  return -basis.at(roots[which]).transpose() / derivative;
}

}  // namespace

Expected<Eigen::MatrixXd> covariance_root(const Lines& lines, const Structure& structure, const Estimate& estimate,
                                          CovarianceKind kind, double degrees_of_freedom, const LineCorrelation& correlation) {
  const auto directions = tangent(lines, structure, estimate);
  if (!directions) return refusal_in(directions);
  const Eigen::MatrixXd columns = free_columns(*directions, structure.estimate_delay);
  const bool information = kind == CovarianceKind::information;
  const Eigen::MatrixXcd slope = (information ? information_root(lines, estimate) : jacobian(lines, estimate)) * columns;
  const Eigen::MatrixXd j = stacked(slope);
  const Eigen::VectorXd length = j.colwise().norm();
  if (!(length.minCoeff() > 0.0) || !length.allFinite()) return refused("the data say nothing about one of the parameters");
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j * length.cwiseInverse().asDiagonal(), Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  if (s[s.size() - 1] < kLeastSingularValue * s[0])
    return refused("the data leave a combination of the parameters free: the order is too high for them");
  const Eigen::MatrixXd scaled = length.cwiseInverse().asDiagonal() * svd.matrixV();
  if (information) {
    const double nu = degrees_of_freedom, few = std::isinf(nu) ? 1.0 : nu / (nu - 2.0);
    return Eigen::MatrixXd(std::sqrt(0.5 * few) * columns * scaled * s.cwiseInverse().asDiagonal());
  }
  const double equations = lines.weight.sum() * static_cast<double>(lines.channels.size());
  if (correlation.any()) {
    const Eigen::MatrixXd white = scaled * s.cwiseInverse().asDiagonal();
    const auto through = [&](std::size_t lags) {
      return Eigen::MatrixXd(white.transpose() * score_covariance(lines, structure, estimate, correlation, lags, slope) * white);
    };
    const auto count = static_cast<double>(columns.cols());
    const double alone = through(1).trace() / count;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(through(correlation.lags.size()));
    const Eigen::VectorXd raised = parts.eigenvalues().cwiseMax(alone);
    const double lost = std::min(0.5 * count * static_cast<double>(2 * correlation.lags.size() - 1), 0.5 * equations);
    const double nu = degrees_of_freedom, few = std::isinf(nu) || !(nu > 2.0) ? 1.0 : (nu - 1.0) / (nu - 2.0);
    return Eigen::MatrixXd(std::sqrt(few * equations / (equations - lost)) * columns * white * parts.eigenvectors() *
                           raised.cwiseSqrt().asDiagonal());
  }
  const double factor = equations / (equations - 0.5 * static_cast<double>(columns.cols()));
  const Eigen::MatrixXd inverse = scaled * s.cwiseAbs2().cwiseInverse().asDiagonal() * scaled.transpose();
  return Eigen::MatrixXd(std::sqrt(factor) * columns * inverse * gradients(slope, residuals(lines, estimate)));
}

Coefficients coefficients_of(const Lines& lines, const Structure& structure, const Estimate& estimate, std::size_t output,
                             const Rational& rational, const Eigen::MatrixXd& root) {
  const Eigen::Index n = structure.order, poles = estimate.bases.denominator.size(), at = estimate.bases.offset(output);
  const Eigen::MatrixXd a = denominator_powers(estimate.bases.denominator, structure, lines.scale),
                        b = estimate.bases.numerators[output].monomials();
  const Eigen::Index m = b.rows() - 1;
  const Eigen::VectorXd numerator = rational.numerator(), denominator = rational.denominator();
  const double top = a.row(n) * estimate.theta.head(poles);
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(m + 1 + n + 1, estimate.theta.size() + 1);
  Coefficients c;
  c.values.resize(m + 1 + n + (structure.estimate_delay ? 1 : 0));
  // With alpha in powers of x: a_p = alpha_p / alpha_n scale^(n-p), and d a_p = (d alpha_p scale^(n-p) - a_p d alpha_n) /
  // alpha_n.
  const auto put = [&](Eigen::Index row, Eigen::Index power, double value, const auto& of_power, Eigen::Index offset) {
    c.values[row] = value;
    slope.row(row).segment(offset, of_power.size()) = std::pow(lines.scale, static_cast<double>(n - power)) / top * of_power;
    slope.row(row).head(poles) -= value / top * a.row(n);
  };
  for (Eigen::Index p = m; p >= 0; --p) {
    c.names.push_back(name_of({false, static_cast<Eigen::Index>(output), p, 0.0}, 1));
    const double value = p < numerator.size() ? numerator[numerator.size() - 1 - p] : 0.0;
    put(m - p, p, value, b.row(p), at);
  }
  for (Eigen::Index p = n - 1; p >= 0; --p) {
    c.names.push_back(name_of({true, 0, p, 0.0}, 1));
    put(m + n - p, p, denominator[n - p], a.row(p), 0);
  }
  if (structure.estimate_delay) {
    c.names.push_back("delay");
    c.values[m + n + 1] = estimate.delay_s;
    slope(m + n + 1, slope.cols() - 1) = 1.0;
  }
  if (root.size() != 0) {
    const Eigen::MatrixXd through = slope.topRows(c.values.size()) * root;
    c.covariance = through * through.transpose();
  }
  return c;
}

Eigen::MatrixXcd pole_slopes(const Lines& lines, const Structure& structure, const Estimate& estimate, const Rational& rational) {
  const Eigen::Index fixed = structure.fixed_poles.size(), size = estimate.bases.denominator.size();
  const Eigen::VectorXcd roots = rational.poles.tail(rational.poles.size() - fixed) / lines.scale;
  Eigen::MatrixXcd slopes = Eigen::MatrixXcd::Zero(rational.poles.size(), estimate.theta.size() + 1);
  for (Eigen::Index i = 0; i < roots.size(); ++i) {
    slopes.row(fixed + i).head(size) =
        lines.scale * slope_of_root(estimate.bases.denominator, estimate.theta.head(size), roots, i);
  }
  return slopes;
}

Eigen::MatrixXcd zero_slopes(const Lines& lines, const Estimate& estimate, std::size_t output, const Rational& rational) {
  const Basis& basis = estimate.bases.numerators[output];
  const Eigen::Index at = estimate.bases.offset(output);
  const Eigen::VectorXcd roots = rational.zeros / lines.scale;
  Eigen::MatrixXcd slopes = Eigen::MatrixXcd::Zero(roots.size(), estimate.theta.size() + 1);
  for (Eigen::Index i = 0; i < roots.size(); ++i) {
    slopes.row(i).segment(at, basis.size()) =
        lines.scale * slope_of_root(basis, estimate.theta.segment(at, basis.size()), roots, i);
  }
  return slopes;
}

Eigen::Matrix2d root_covariance(const Eigen::RowVectorXcd& slope, const Eigen::MatrixXd& root) {
  Eigen::MatrixXd parts(2, slope.size());
  parts << slope.real(), slope.imag();
  const Eigen::MatrixXd through = parts * root;
  return through * through.transpose();
}

}  // namespace bodeflow::maximum_likelihood
