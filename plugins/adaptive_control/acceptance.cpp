#include "acceptance.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::adaptive_control {

bool roots_inside(const Coefficients& polynomial, int n, double radius) {
  Coefficients a{}, next{};
  double power = 1.0;  // p(radius x) / radius^n has its roots inside the unit circle
  for (std::size_t i = 0; i <= static_cast<std::size_t>(n); ++i) {
    a[i] = polynomial[i] * power;
    power /= radius;
  }
  for (auto degree = static_cast<std::size_t>(n); degree > 0; --degree) {
    const double reflection = a[degree] / a[0];
    if (!(std::abs(reflection) < 1.0)) return false;
    for (std::size_t i = 0; i < degree; ++i) next[i] = a[i] - reflection * a[degree - i];
    a = next;
  }
  return true;
}

double sensitivity_at_points(const RstDesign& design, const Rst& c, const std::complex<double>* g) {
  double largest = 0.0;
  for (int j = 0; j < design.points(); ++j) {
    const std::complex<double> z = design.z(j);
    const std::complex<double> r = value_at(c.r, c.n_r, z), s = value_at(c.s, c.n_s, z);
    const std::complex<double> closed = r + g[j] * s;
    largest = std::max(largest, std::norm(r) / std::norm(closed));  // 1 / (1 + G S / R) = R / (R + G S)
  }
  return std::sqrt(largest);
}

Verdict judge(const RstDesign& design, const RstResult& result, const std::complex<double>* g, const AcceptanceLimits& limits) {
  if (!roots_inside(result.r_bar, design.n_r_bar(), limits.pole_radius)) return {Refusal::controller_pole, limits.pole_radius};
  if (!(result.residual < limits.residual)) return {Refusal::residual, result.residual};
  const double sensitivity = sensitivity_at_points(design, result.rst, g);
  if (!(sensitivity < limits.sensitivity)) return {Refusal::sensitivity, sensitivity};
  return {};
}

const char* words_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return "accepted";
    case Refusal::no_solution:
      return "the least-squares fit has no solution with t0 > 0";
    case Refusal::controller_pole:
      return "the controller has a pole outside of the allowed radius";
    case Refusal::residual:
      return "the fit to the desired response leaves too large a residual";
    case Refusal::sensitivity:
      return "the sensitivity at the points of fitting is too large";
  }
  return "";
}

}  // namespace bodeflow::adaptive_control
