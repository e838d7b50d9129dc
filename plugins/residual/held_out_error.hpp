#pragma once

#include "experiment.hpp"

namespace bodeflow::residual {

/// The error of a model on an experiment beside what the noise alone would leave, in the unit of the output.
struct HeldOutError {
  double error = 0.0;    ///< root mean square of measured minus predicted mean period, within the band of the lines
  double floor = 0.0;    ///< expected from the noise alone
  double highest = 0.0;  ///< the noise alone stays below it with a probability of 99.9 %
  double lowest = 0.0;   ///< the noise alone falls below it with a probability of 1e-4: less is a leak of the measured output
  bool at_floor() const { return error <= highest; }
  bool leak() const { return error < lowest; }
  /// What is not noise: sqrt(error^2 - floor^2), 0 below the floor.
  double excess() const;
};

/// The error over all lines. error^2 / floor^2 is F distributed, with the effective degrees of freedom of the sum over the lines
/// (Satterthwaite: 2 (sum m)^2 / sum (2 m^2 / d), m the mean and d the degrees of freedom of a line) and those of the floor.
HeldOutError held_out_error(const Experiment& experiment, const Eigen::VectorXcd& predicted);

}  // namespace bodeflow::residual
