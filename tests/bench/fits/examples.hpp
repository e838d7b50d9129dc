#pragma once

#include <string>
#include <vector>

#include "sanathanan_koerner/data.hpp"

namespace bench {

/// Data to fit, weights 1.
struct Example {
  std::string name;
  bodeflow::sanathanan_koerner::Data data;
  Eigen::Index ports = 1;            ///< inputs, and as many outputs
  std::vector<Eigen::Index> orders;  ///< to fit: poles
};

/// The transformer ladders of the reference files with .1 % noise, and the measured responses of the folder BODEFLOW_DATA, where
/// that is set. Throws what keeps a file from being read.
std::vector<Example> examples();

}  // namespace bench
