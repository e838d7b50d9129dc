#pragma once

#include <bodeflow/numerics/linear_system.hpp>
#include <vector>

namespace bodeflow::plants {

/// How fast a continuous model is.
struct Dynamics {
  std::vector<double> modes_hz;  ///< |p| / 2 pi of its poles, rising, a conjugate pair once; poles at zero are left out
  double settling_s = 0.0;       ///< 5 time constants of the slowest pole; infinite for a pole that does not decay
};

/// The modes and settling time of a model. Equal poles stand once each.
Dynamics dynamics_of(const numerics::StateSpace& model);

}  // namespace bodeflow::plants
