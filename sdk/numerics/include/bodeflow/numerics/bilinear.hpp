#pragma once

#include "bodeflow/numerics/linear_system.hpp"

namespace bodeflow::numerics {

/// The system in z = (a + s) / (a - s), which takes the left half plane into the unit disc and s = j w to the angle 2 atan(w /
/// a):
///   A_z = (a I + A)(a I - A)^-1, B_z = sqrt(2 a)(a I - A)^-1 B, C_z = sqrt(2 a) C (a I - A)^-1, D_z = D + C (a I - A)^-1 B.
/// `a` in rad/s; 2 / sample_time is Tustin's rule. Hankel singular values stay as they are. `sample_time` is that of the result.
/// Errors: a system that is discrete, a or sample_time not above 0, a pole at s = a.
Expected<StateSpace> bilinear(const StateSpace& system, double a, double sample_time);

/// The continuous-time system whose `bilinear` map is the given one: s = a (z - 1) / (z + 1). Errors: a system that is
/// continuous, a not above 0, a pole at z = -1.
Expected<StateSpace> undo_bilinear(const StateSpace& system, double a);

/// The a with which a bilinear map keeps the response at w [rad/s]: w / tan(w T / 2). 0 < w < pi / T; at w = 0 it is 2 / T.
double prewarped(double omega_rad_s, double sample_time);

}  // namespace bodeflow::numerics
