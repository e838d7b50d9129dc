#pragma once

#include <Eigen/Core>
#include <vector>

#include "windows.hpp"

namespace bodeflow::frisch {

/// The lines k = 1 .. (N-1)/2 at which the mean period of a signal has at least `threshold` times the magnitude of its strongest
/// one: those that a multisine excites. Errors: fewer samples than one period; a period below 3; a signal without any line.
Expected<std::vector<Eigen::Index>> excited_lines(const Eigen::VectorXd& signal, Eigen::Index period, double threshold = 0.3);

}  // namespace bodeflow::frisch
