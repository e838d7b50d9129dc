#pragma once

#include "sampled/record_residual.hpp"

namespace bodeflow::residual {

/// Adds to `s` what a record says with a base model and what that leaves: sizes of signals, of flow, stored quantity and effort
/// at the place (Addition::kNoPlace: none), the response that is missing, peaks and changes of the residual. Larger sizes win.
/// `inverse`: the input is a position with its derivatives; no response is told.
void describe_situation(const SampledRecord& record, bool inverse, const JointModel& base, const Eigen::VectorXd& values,
                        std::size_t place, Situation& s);

}  // namespace bodeflow::residual
