#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "data.hpp"
#include "records/signals.hpp"

namespace bodeflow::sanathanan_koerner {

enum class Weighting { automatic, absolute, relative, variance };

/// D. A. Jue's tiered weights, equation (3): 1 within a band, less below and above it.
struct Tiers {
  double low_rad_s = 0.0, high_rad_s = 0.0;
  double below = 0.1, above = 1e-4;
};

/// Which part of a response is fitted, and how its lines weigh.
struct Selection {
  std::vector<std::string> inputs, outputs;  ///< empty: all
  std::string band;
  Weighting weighting = Weighting::automatic;
  std::optional<Tiers> tiers;
};

/// A response as it is fitted, with what its record says about it.
struct Measured {
  Data data;
  Eigen::MatrixXd deviation;    ///< of the response, lines x channels; empty where it is not known
  bool known_variance = false;  ///< the weights are one over the deviation
  records::Signals inputs, outputs;
  std::vector<std::string> units;  ///< one a channel
  double sample_time_s = 0.0;      ///< 0: not known
  double degrees_of_freedom = INFINITY;
  std::int64_t correlated_lines = 0;
  double input_amplitude = 0.0;  ///< 0: not known
  std::string checksum;
};

/// What of the record is fitted. Errors, by name: those of read_response and check, names that are not in it, a band without
/// lines, weights by a variance that is absent or zero, relative weights where the response is zero.
Expected<Measured> read_measured(const RecordView& record, const Selection& selection);

/// The weights by tiers at the lines.
Eigen::VectorXd tiered_weights(const Eigen::VectorXd& omega_rad_s, const Tiers& tiers);

}  // namespace bodeflow::sanathanan_koerner
