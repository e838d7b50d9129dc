#pragma once

#include <memory>

#include "trace/joint_fit.hpp"

namespace bodeflow::residual {

/// A fitted model on a record that was not fitted. Parameters that each record has for itself are fitted to it, the shared ones
/// are left as they are.
struct HeldOut {
  Eigen::VectorXd values;
  Eigen::VectorXd residual;
  Eigen::Index fitted = 0;  ///< numbers that the record determined: own parameters, and those that it eliminates
};
/// Errors: the model can't be computed on that record.
Expected<HeldOut> hold_out(const JointModel& model, const Eigen::VectorXd& values, const Measurement& record);
inline Expected<HeldOut> hold_out(const Fit& fit, const Measurement& record) { return hold_out(fit.model, fit.values(), record); }

/// Class tests of a fitted record, and of one that was not fitted.
std::vector<ClassTest> fitted_tests(const Fit& fit, const Measurements& records, std::size_t record);
std::vector<ClassTest> held_out_tests(const Fit& fit, const HeldOut& held_out, const Measurement& record);

}  // namespace bodeflow::residual
