#include "rational.hpp"

#include <bodeflow/numerics/polynomial.hpp>
#include <cmath>

#include "coefficients.hpp"

namespace bodeflow::maximum_likelihood {

namespace {

Eigen::VectorXd multiplied_out(const Eigen::VectorXcd& roots) {
  Eigen::VectorXcd p = Eigen::VectorXcd::Ones(1);
  for (const std::complex<double> root : roots) {
    Eigen::VectorXcd longer = Eigen::VectorXcd::Zero(p.size() + 1);
    longer.head(p.size()) += p;
    longer.tail(p.size()) -= root * p;
    p = longer;
  }
  return p.real();
}

}  // namespace

Eigen::VectorXd Rational::numerator() const { return gain * multiplied_out(zeros); }

Eigen::VectorXd Rational::denominator() const { return multiplied_out(poles); }

std::complex<double> Rational::response(double omega_rad_s) const {
  const std::complex<double> s(0.0, omega_rad_s);
  const std::complex<double> x = sample_time_s > 0.0 ? std::exp(s * sample_time_s) : s;
  // Factor by factor, that high orders stay within the range of a double.
  std::complex<double> g = gain * std::exp(-s * delay_s);
  for (Eigen::Index i = 0; i < std::max(poles.size(), zeros.size()); ++i) {
    if (i < zeros.size()) g *= x - zeros[i];
    if (i < poles.size()) g /= x - poles[i];
  }
  return g;
}

Expected<Rational> rational_of(const Lines& lines, const Structure& structure, const Estimate& estimate, std::size_t output,
                               double sample_time_s) {
  const Basis& basis = estimate.bases.numerators[output];
  const Eigen::VectorXd a = estimate.theta.head(estimate.bases.denominator.size()),
                        b = estimate.theta.segment(estimate.bases.offset(output), basis.size());
  const Eigen::VectorXcd poles = estimate.bases.denominator.roots(a), zeros = basis.roots(b);
  if (poles.size() < structure.free_poles()) return refused("the highest coefficient of the denominator is 0: lower the order");
  Rational r;
  r.poles.resize(structure.order);
  r.poles << structure.fixed_poles, lines.scale * poles;
  r.zeros = lines.scale * zeros;
  const double top = basis.monomials()(zeros.size(), zeros.size()) * b[zeros.size()];
  if (top == 0.0) return refused("the numerator of output " + std::to_string(output + 1) + " is 0");
  const Eigen::Index n = poles.size();
  r.gain = top / (estimate.bases.denominator.monomials()(n, n) * a[n]) *
           std::pow(lines.scale, static_cast<double>(structure.order - zeros.size()));
  r.delay_s = estimate.delay_s;
  if (structure.domain == Domain::z) r.sample_time_s = sample_time_s;
  if (!std::isfinite(r.gain) || !r.poles.allFinite() || !r.zeros.allFinite())
    return refused("the model is beyond the range of numbers: lower the order");
  return r;
}

}  // namespace bodeflow::maximum_likelihood
