#pragma once

#include "sampled/stretch.hpp"

namespace bodeflow::residual {

/// How much more of the squares one residual has than another, by 40 blocks of their rows: the mean of the differences of block
/// means over its own deviation. Normal with variance 1 where both are equally good and blocks are long beside the residual's
/// memory; infinite (with the sign of the mean) where all blocks differ alike, 0 where there are fewer than 40 rows.
double block_deviates(const Eigen::VectorXd& before, const Eigen::VectorXd& after);

/// How far a residual drifts from the record's begin to its end, and the deviation of that, from the scatter of 40 block means
/// about a straight line.
struct Drift {
  double rise = 0.0;
  double std = 0.0;
};
Drift drift_of(const Eigen::VectorXd& residual);

}  // namespace bodeflow::residual
