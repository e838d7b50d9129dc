#pragma once

#include "periodic/periodic_record.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// Adds to a situation what a record says with a base model and its residual: signal sizes, the place, the missing response at
/// the excited lines, tones between the lines, instants at which the residual changes.
void say_bins(const PeriodicRecord& record, const JointModel& base, const Eigen::VectorXd& values, std::size_t place,
              Situation& s);

}  // namespace bodeflow::residual
