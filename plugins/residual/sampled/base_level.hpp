#pragma once

#include "expected.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// A base model fitted to one record alone: its values. For the size of what it leaves, and for how the record is cut.
/// Errors: no start at which the model can be computed on the record.
Expected<Eigen::VectorXd> fit_base(const JointModel& base, const Measurement& record,
                                   const std::vector<std::vector<double>>& starts);

}  // namespace bodeflow::residual
