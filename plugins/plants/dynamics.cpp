#include "dynamics.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bodeflow::plants {

Dynamics dynamics_of(const numerics::StateSpace& model) {
  constexpr double kTimeConstants = 5.0;
  Dynamics dynamics;
  if (model.states() == 0) return dynamics;
  double slowest = std::numeric_limits<double>::infinity();
  const Eigen::VectorXcd poles = model.A.eigenvalues();
  for (const std::complex<double>& p : poles) {
    slowest = std::min(slowest, -p.real());
    if (p.imag() >= 0.0 && std::abs(p) > 0.0) dynamics.modes_hz.push_back(std::abs(p) / (2 * std::numbers::pi));
  }
  std::sort(dynamics.modes_hz.begin(), dynamics.modes_hz.end());
  dynamics.settling_s = slowest > 0.0 ? kTimeConstants / slowest : std::numeric_limits<double>::infinity();
  return dynamics;
}

}  // namespace bodeflow::plants
