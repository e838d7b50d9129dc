#include "coefficients.hpp"

#include <Eigen/SVD>
#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr double kDependent = 1e-10;  // smallest over largest singular value of conditions that are the same

}  // namespace

Eigen::MatrixXd denominator_powers(const Basis& basis, const Structure& structure, double scale) {
  const Eigen::MatrixXd free = basis.monomials();
  const auto fixed = numerics::polynomial_from_roots(structure.fixed_poles / scale);
  if (!fixed) return free;
  const Eigen::Index extra = fixed->size() - 1;
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(free.rows() + extra, free.cols());
  for (Eigen::Index p = 0; p <= extra; ++p) whole.middleRows(p, free.rows()) += (*fixed)[extra - p] * free;
  return whole;
}

Expected<Eigen::MatrixXd> free_directions(const Bases& bases, const Structure& structure, double scale) {
  const auto count = static_cast<Eigen::Index>(structure.fixed.size());
  if (count == 0) return Eigen::MatrixXd(Eigen::MatrixXd::Identity(bases.size(), bases.size()));
  const Eigen::MatrixXd whole = denominator_powers(bases.denominator, structure, scale);
  Eigen::MatrixXd conditions = Eigen::MatrixXd::Zero(count, bases.size());
  for (Eigen::Index f = 0; f < count; ++f) {
    const FixedCoefficient& c = structure.fixed[static_cast<std::size_t>(f)];
    // alpha_power - value scale^(power - n) alpha_n = 0 with alpha the coefficients in x; likewise for beta.
    auto row = conditions.row(f);
    const double value = c.value * std::pow(scale, static_cast<double>(c.power - structure.order));
    row.head(whole.cols()) = -value * whole.row(structure.order);
    if (c.of_denominator) {
      row.head(whole.cols()) += whole.row(c.power);
    } else {
      const auto i = static_cast<std::size_t>(c.output);
      row.segment(bases.offset(i), bases.numerators[i].size()) += bases.numerators[i].monomials().row(c.power);
    }
    row /= row.norm();
  }
  if (count + 2 > bases.size()) return refused("all coefficients are fixed");
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(conditions, Eigen::ComputeFullV);
  if (svd.singularValues()[count - 1] < kDependent * svd.singularValues()[0])
    return refused("the fixed coefficients repeat each other");
  const Eigen::MatrixXd free = svd.matrixV().rightCols(bases.size() - count);
  const Eigen::VectorXd highest = whole.row(structure.order);
  if ((highest.transpose() * free.topRows(whole.cols())).norm() < kDependent * highest.norm())
    return refused("the fixed coefficients contradict each other: they leave the denominator without its highest coefficient");
  return free;
}

}  // namespace bodeflow::maximum_likelihood
