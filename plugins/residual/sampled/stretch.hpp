#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodeflow::residual {

/// Rows of a measurement that follow each other in time without a break: a record, or a segment of one.
struct Stretch {
  Eigen::Index first = 0;
  Eigen::Index count = 0;
};
using Stretches = std::vector<Stretch>;

}  // namespace bodeflow::residual
