#pragma once

#include <Eigen/Core>
#include <span>

#include "model/joint_model.hpp"

namespace bodeflow::residual {

/// Adds to s.place what the base model does there: the largest flow and deflection of these courses (samples x places, may be
/// empty), its linear coefficient, and a reaction that does as much as the input does (from s.input_peak; for a plant without
/// states from s.output_peak). Larger sizes win.
void say_place(const JointModel& base, const Eigen::VectorXd& values, std::span<const double> known, const Eigen::MatrixXd& flow,
               const Eigen::MatrixXd& stored, std::size_t place, Situation& s);

}  // namespace bodeflow::residual
