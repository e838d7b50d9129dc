#include "monomial.hpp"

#include <Eigen/QR>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

#include "elimination.hpp"
#include "stacked.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

using Complex = std::complex<double>;

/// Weighted 1, z^-1 .. z^-M, stacked.
Eigen::MatrixXd powers(const Eigen::VectorXcd& z, const Eigen::VectorXd& w, Eigen::Index order) {
  Eigen::MatrixXd columns(2 * z.size(), order + 1);
  Eigen::VectorXcd power = w.cast<Complex>();
  for (Eigen::Index m = 0; m <= order; ++m) {
    columns.col(m) = stacked(power);
    power = power.cwiseQuotient(z);
  }
  return columns;
}

/// 1, d_1 .. d_M that minimise |R d|, columns scaled.
Eigen::VectorXd monic_solution(const Eigen::MatrixXd& R) {
  const Eigen::Index M = R.cols() - 1;
  Eigen::VectorXd length = R.rightCols(M).colwise().norm();
  for (double& l : length)
    if (l == 0.0) l = 1.0;
  const Eigen::MatrixXd scaled = R.rightCols(M) * length.cwiseInverse().asDiagonal();
  Eigen::VectorXd d(M + 1);
  d[0] = 1.0;
  d.tail(M) = scaled.colPivHouseholderQr().solve(-R.col(0)).cwiseQuotient(length);
  return d;
}

Eigen::VectorXcd values(const Eigen::VectorXd& d, const Eigen::VectorXcd& z) {
  return z.unaryExpr([&](Complex at) { return numerics::evaluate(d.reverse(), 1.0 / at); });
}

MonomialIterate iterate_of(const Data& data, const Eigen::VectorXd& q, const Eigen::VectorXcd& z, const Eigen::VectorXd& d) {
  const Eigen::Index M = d.size() - 1;
  MonomialIterate it{d, Eigen::MatrixXd(M + 1, data.channels()), 0.0, 0};
  const Eigen::VectorXcd below = values(d, z);
  const Eigen::VectorXd w = q.array() / below.array().abs();
  const Elimination elimination(data, q, powers(z, w, M), false);
  Eigen::MatrixXcd model(data.lines(), data.channels());
  for (Eigen::Index i = 0; i < data.channels(); ++i) {
    const Eigen::VectorXcd aim = elimination.ratio(i).cwiseProduct(w).cwiseProduct(below).cwiseProduct(data.response.col(i));
    it.numerators.col(i) = elimination.coefficients(i, stacked(aim));
    model.col(i) = values(it.numerators.col(i), z).cwiseQuotient(below);
  }
  it.error = weighted_residual(data, model).norm() / weighted_norm(data);
  if (const auto roots = numerics::roots(d)) it.unstable = (roots->array().abs() >= 1.0).count();
  return it;
}

}  // namespace

Expected<std::vector<MonomialIterate>> monomial_iterates(const Data& data, const Plane& plane, const FitSettings& settings) {
  if (auto good = check(data); !good) return unexpected(good.error().text);
  if (auto good = check_order(data, settings.order); !good) return unexpected(good.error().text);
  const Eigen::VectorXd q = shared_weights(data);
  const Eigen::VectorXcd z = plane.circle(data.omega_rad_s);
  Eigen::VectorXcd d = Eigen::VectorXcd::Ones(data.lines());
  std::vector<MonomialIterate> iterates;
  Course course;
  do {
    const Eigen::VectorXd w = q.array() / d.array().abs().pow(settings.weight_exponent);
    const Eigen::MatrixXd columns = powers(z, w, settings.order);
    if (!columns.allFinite()) break;
    const Elimination elimination(data, q, columns, false);
    Eigen::MatrixXcd factors(data.lines(), data.channels());
    for (Eigen::Index i = 0; i < data.channels(); ++i) factors.col(i) = elimination.ratio(i).cwiseProduct(data.response.col(i));
    const Eigen::VectorXd next = monic_solution(condensed(elimination, factors, columns));
    if (!next.allFinite()) break;
    iterates.push_back(iterate_of(data, q, z, next));
    d = values(next, z);
    note(course, iterates.back().error);
  } while (!should_stop(course, settings.stop));
  if (iterates.empty())
    return unexpected("no model of order " + std::to_string(settings.order) + ": the equations are not finite");
  return iterates;
}

Expected<Fit> monomial_fit(const Data& data, const Plane& plane, const FitSettings& settings) {
  const auto iterates = monomial_iterates(data, plane, settings);
  if (!iterates) return unexpected(iterates.error().text);
  Course course;
  const MonomialIterate* best = nullptr;
  for (const MonomialIterate& it : *iterates) {
    course.errors.push_back(it.error);
    if ((settings.stable && it.unstable > 0) || !std::isfinite(it.error) || (best != nullptr && it.error >= best->error))
      continue;
    best = &it;
    course.best = static_cast<int>(course.errors.size()) - 1;
  }
  if (best == nullptr)
    return unexpected("no iterate of order " + std::to_string(settings.order) + " in powers of 1/z is stable: lower the order");
  const Eigen::VectorXcd z = plane.circle(data.omega_rad_s);
  const auto M = static_cast<double>(settings.order);
  const Eigen::VectorXcd below = values(best->denominator, z).array() * z.array().pow(M);
  auto f = with_denominator(data, plane, below, settings.order);
  if (!f) return f;
  course.reason = "the best stable of " + std::to_string(iterates->size()) + " iterates";
  course.errors[static_cast<std::size_t>(course.best)] = f->error();
  f->course = course;
  return f;
}

}  // namespace bodeflow::sanathanan_koerner
