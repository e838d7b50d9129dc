#pragma once

#include <bodeflow/numerics/discretise.hpp>

namespace bodeflow::validation {

/// The system and its delay at the samples of an input that is linear between them: exact for such an input, and near to a
/// band-limited one far below half the sample rate, whose component at the frequency f it takes by (sin(x) / x)^2, x = pi f T.
///
/// Method: the input's slope as a held input of an integrator before the system. x[n+1] = Phi x[n] + G1 u[n] + G2 (u[n+1] -
/// u[n]); the state x[n] - G2 u[n] needs no sample ahead. A delay that is no whole number of samples is taken at the output,
/// within the sample. Errors: those of numerics::zero_order_hold. Reference: G. F. Franklin, J. D. Powell, M. Workman, Digital
/// Control of Dynamic Systems, 3rd ed., 1998, section 6.3.2.
numerics::Expected<numerics::DelayedModel> first_order_hold(const numerics::StateSpace& system, double sample_time_s,
                                                            double delay_s);

}  // namespace bodeflow::validation
