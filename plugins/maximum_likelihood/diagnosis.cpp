#include "diagnosis.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>
#include <limits>

namespace bodeflow::maximum_likelihood {

namespace {

using Complex = std::complex<double>;

constexpr double kPairLimit = 5.991;  // 95 % of chi-squared with 2 degrees
constexpr double kRealLimit = 3.841;  // with 1
constexpr double kNear = 0.3;         // relative distance above which a root of large uncertainty is far away, not near another
constexpr Eigen::Index kLeastLines = 8;
constexpr Eigen::Index kMostLags = 10;

bool is_real(Complex x) { return x.imag() == 0.0; }

// Whether a difference with that slope on the parameters may be 0.
bool may_vanish(Complex difference, const Eigen::RowVectorXcd& slope, const Eigen::MatrixXd& root, bool real) {
  const Eigen::Matrix2d covariance = root_covariance(slope, root);
  if (real) return difference.real() * difference.real() < kRealLimit * covariance(0, 0);
  const Eigen::Vector2d d(difference.real(), difference.imag());
  const double determinant = covariance.determinant();
  if (!(determinant > 0.0)) return false;
  return d.dot(covariance.inverse() * d) < kPairLimit;
}

}  // namespace

CostTest cost_test(const Spectra& spectra, const Fit& fit) {
  const double nu = spectra.degrees_of_freedom;
  CostTest t;
  t.cost = fit.minimum.cost;
  t.degrees_of_freedom = 2.0 * spectra.equations() - static_cast<double>(fit.parameters());
  const double f = spectra.equations() - 0.5 * fit.inflation * static_cast<double>(fit.parameters());
  t.expected = std::isinf(nu) ? f : nu > 1.0 ? f * nu / (nu - 1.0) : std::numeric_limits<double>::infinity();
  if (!(nu > 2.0)) return t;
  double variance = std::isinf(nu) ? f : f * nu * nu * nu / ((nu - 1.0) * (nu - 1.0) * (nu - 2.0));
  if (fit.correlation.any()) variance *= fit.correlation.lines_of_one();
  t.deviation = std::sqrt(variance);
  const double shape = 2.0 * t.expected * t.expected / variance;
  t.probability = numerics::chi_squared_tail(t.cost * shape / t.expected, shape);
  return t;
}

Criteria criteria(const Spectra& spectra, const Fit& fit) {
  const double equations = spectra.equations(), nu = spectra.degrees_of_freedom,
               n = fit.inflation * static_cast<double>(fit.parameters());
  const double part = std::isinf(nu) || !(nu > 2.0) ? 1.0 : (nu - 2.0) / nu;
  const double fit_term =
      spectra.variance_known ? 2.0 * fit.minimum.cost * part : 2.0 * equations * std::log(fit.minimum.cost / equations);
  return {fit_term + 2.0 * n, fit_term + n * std::log(2.0 * equations)};
}

std::optional<Whiteness> whiteness(const Eigen::VectorXcd& errors, Eigen::Index distance) {
  const Eigen::Index lines = errors.size();
  if (lines < kLeastLines || !(errors.cwiseAbs().minCoeff() > 0.0)) return std::nullopt;
  const Eigen::VectorXcd direction = errors.array() / errors.array().abs();
  Whiteness w;
  const auto power_at = [&](Eigen::Index lag) {
    return std::norm(direction.head(lines - lag).dot(direction.tail(lines - lag))) / static_cast<double>(lines - lag);
  };
  const Eigen::Index step = distance + 1;
  w.lags = std::min(kMostLags, lines / (4 * step));
  if (w.lags == 0) return std::nullopt;
  double lines_of_one = 1.0;
  for (Eigen::Index lag = 1; lag <= distance; ++lag) lines_of_one += 2.0 * power_at(lag) / static_cast<double>(lines - lag);
  for (Eigen::Index lag = 1; lag <= w.lags; ++lag) w.statistic += 2.0 * power_at(lag * step) / lines_of_one;
  w.probability = numerics::chi_squared_tail(w.statistic, 2.0 * static_cast<double>(w.lags));
  return w;
}

std::vector<Cancellation> cancellations(const Fit& fit, const Eigen::MatrixXd& root) {
  std::vector<Cancellation> found;
  if (root.size() == 0) return found;
  const Estimate& estimate = fit.minimum.estimate;
  for (std::size_t i = 0; i < fit.models.size(); ++i) {
    const Rational& model = fit.models[i];
    const Eigen::MatrixXcd poles = pole_slopes(fit.lines, fit.structure, estimate, model),
                           zeros = zero_slopes(fit.lines, estimate, i, model);
    for (Eigen::Index p = 0; p < model.poles.size(); ++p) {
      for (Eigen::Index z = 0; z < model.zeros.size(); ++z) {
        const Complex pole = model.poles[p], zero = model.zeros[z];
        if (pole.imag() < 0.0 || zero.imag() < 0.0 || is_real(pole) != is_real(zero)) continue;
        if (std::abs(pole - zero) > kNear * std::max(std::abs(pole), std::abs(zero))) continue;
        if (may_vanish(pole - zero, poles.row(p) - zeros.row(z), root, is_real(pole))) found.push_back({pole, zero, i});
      }
    }
  }
  return found;
}

std::vector<UnstablePole> unstable_poles(const Fit& fit, const Eigen::MatrixXd& root) {
  std::vector<UnstablePole> found;
  const Rational& model = fit.models.front();
  const Eigen::MatrixXcd slopes = pole_slopes(fit.lines, fit.structure, fit.minimum.estimate, model);
  for (Eigen::Index p = fit.structure.fixed_poles.size(); p < model.poles.size(); ++p) {
    const Complex pole = model.poles[p];
    const bool s = fit.structure.domain == Domain::s;
    const double beyond = s ? pole.real() : std::abs(pole) - 1.0;
    if (!(beyond > 0.0) || pole.imag() < 0.0) continue;
    double deviation = 0.0;
    if (root.size() != 0) {
      const Complex outward = s ? Complex(1.0) : pole / std::abs(pole);
      deviation = (((std::conj(outward) * slopes.row(p)).real()) * root).norm();
    }
    found.push_back({pole, deviation > 0.0 ? beyond / deviation : std::numeric_limits<double>::infinity()});
  }
  return found;
}

}  // namespace bodeflow::maximum_likelihood
