#include "magnetising_curve.hpp"

#include <cmath>
#include <cstddef>

namespace bodeflow::drive {
namespace {

constexpr int kSteps = 4096;
constexpr double kSaturated = 20.0;  // tanh(20) is 1 in doubles
constexpr int kNewtonSteps = 60;

}  // namespace

MagnetisingCurve::MagnetisingCurve(double lm, double isat, double share, double a, double g)
    : lm_(lm), isat_(isat), share_(share), a_(a), g_(g) {
  const double last = kSaturated * isat, most = a * last + g * flux(last), step = most / kSteps;
  per_step_ = 1.0 / step;
  offset_ = g * lm * share * isat;
  steepness_ = a + g * lm * (1.0 - share);
  nodes_.resize(kSteps + 1);
  nodes_[0] = {1.0 / (a + g * lm), 0.0};
  double i = 0.0;
  for (int k = 1; k <= kSteps; ++k) {
    const double m = k * step;
    i = solve(m, i);
    const double bend = std::cosh(i / isat);
    const double rise = 1.0 / (a + g * lm * (1.0 - share + share / (bend * bend)));
    nodes_[static_cast<std::size_t>(k)] = {i / m, (rise - i / m) / m * step};
  }
}

double MagnetisingCurve::flux(double i) const { return lm_ * ((1.0 - share_) * i + share_ * isat_ * std::tanh(i / isat_)); }

/// Newton's method from below: M(i) is concave there, so the steps never go beyond the root after the first.
double MagnetisingCurve::solve(double m, double start) const {
  double i = start;
  for (int k = 0; k < kNewtonSteps; ++k) {
    const double bend = std::cosh(i / isat_);
    const double slope = a_ + g_ * lm_ * (1.0 - share_ + share_ / (bend * bend));
    const double step = (m - a_ * i - g_ * flux(i)) / slope;
    i += step;
    if (std::abs(step) <= 1e-15 * i) break;
  }
  return i;
}

double MagnetisingCurve::current_share(double m) const {
  const double place = m * per_step_;
  if (!(place < kSteps)) return (m - offset_) / (steepness_ * m);
  const auto k = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(k), u = 1.0 - t;
  const Node &left = nodes_[k], &right = nodes_[k + 1];
  return u * u * ((1.0 + 2.0 * t) * left.value + t * left.slope) + t * t * ((1.0 + 2.0 * u) * right.value - u * right.slope);
}

}  // namespace bodeflow::drive
