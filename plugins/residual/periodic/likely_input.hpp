#pragma once

#include "periodic/periodic_record.hpp"

namespace bodeflow::residual {

/// Puts what the input most probably was in the place of the measured one, and the noise that it still has; false where the model
/// can't be computed. At the excited lines the output is moved by what a linear plant makes of the difference, so that measured
/// minus predicted there is what it was with the measured input, with the same variance.
///
/// Method: maximum likelihood of the true input U of every excited line, measured as Um with the variance v, beside the output Y
/// = F(U), measured with the variance w: steps (|G|^2 / w + 1 / v)^-1 (conj(G) (Y - F(U)) / w - (U - Um) / v) with the measured
/// gain G = Y / Um.
bool take_likely_input(const JointModel& model, const Eigen::VectorXd& values, PeriodicRecord& record);

/// Adds noise of the variance that the input has to its excited lines, of that draw and `sign` times, and what a linear plant
/// makes of it to the output.
void add_input_noise(std::uint64_t draw, double sign, PeriodicRecord& record);

}  // namespace bodeflow::residual
