#pragma once

#include <optional>
#include <string>
#include <utility>
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

/// The responses of a file. quantities: those of several that it has; band_hz: the lines; empty: all.
Example measured(const std::string& name, const std::string& path, const std::vector<std::string>& quantities,
                 std::optional<std::pair<double, double>> band_hz, std::vector<Eigen::Index> orders);

/// The transformer ladders of the reference files with .1 % noise, and the measured responses of the folder BODEFLOW_DATA, where
/// that is set. Throws what keeps a file from being read.
std::vector<Example> examples();

}  // namespace bench
