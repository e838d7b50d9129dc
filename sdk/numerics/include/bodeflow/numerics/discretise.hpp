#pragma once

#include <Eigen/Core>

#include "bodeflow/numerics/linear_system.hpp"

namespace bodeflow::numerics {

/// A delay as whole samples and a rest in [0, sample_time).
struct SplitDelay {
  Eigen::Index samples = 0;
  double rest_s = 0.0;
};

/// `delay_s` = samples * sample_time + rest_s. A quotient within 1e-9 of a whole number (relative above 1) counts as whole:
/// decimal numbers such as 3 * 0.1 are not exact. delay_s >= 0 and sample_time > 0, both finite.
SplitDelay split_delay(double delay_s, double sample_time);

/// A discrete-time system whose input comes `delay` samples late: x[n+1] = A x[n] + B u[n - delay], y[n] = C x[n] + D u[n -
/// delay].
struct DelayedModel {
  StateSpace model;
  Eigen::Index delay = 0;
};

/// The discrete-time system that equals `system` at the sample times n * sample_time when its input is u[n] held over
/// [n, n + 1) * sample_time and then delayed by `delay_s`.
///
/// Method, exact up to rounding: with tau = d h + tau', 0 <= tau' < h, and Phi(t), Gamma(t) = int_0^t exp(A v) dv B from
/// exp([A B; 0 0] t) = [Phi Gamma; 0 I] (Van Loan, "Computing integrals involving the matrix exponential", IEEE Trans. Autom.
/// Control 23, 1978; the exponential itself by scaling and squaring, Higham 2005, after balancing by powers of two):
///   x[n+1] = Phi(h) x[n] + Phi(h - tau') Gamma(tau') u[n-d-1] + Gamma(h - tau') u[n-d]
/// (Astrom & Wittenmark, Computer-Controlled Systems, 3rd ed. 1997, section 3.2). Where tau' > 0 the states are [x[n]; u[n-d-1]],
/// as many more as there are inputs, and feed-through acts through the last sample: y[n] = C x[n] + D u[n-d-1]. `delay` is d.
/// Cost: O((states + inputs)^3). Errors: a system that is not continuous, a sample time that is not above 0, a negative delay, a
/// result beyond the range of a double.
Expected<DelayedModel> zero_order_hold(const StateSpace& system, double sample_time, double delay_s = 0.0);

/// The continuous-time system whose zero-order hold without delay is the given one: the principal logarithm of [A B; 0 I] over
/// the sample time. Modes above half the sample rate come back below it. Errors: a system that is continuous, a pole at 0 or on
/// the negative real axis, which no real system of as many states has.
Expected<StateSpace> undo_zero_order_hold(const StateSpace& system);

}  // namespace bodeflow::numerics
