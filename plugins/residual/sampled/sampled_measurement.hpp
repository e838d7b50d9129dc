#pragma once

#include <memory>
#include <string>
#include <vector>

#include "records/recording.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

struct SampledOptions {
  /// Length of the segments that are simulated from a state of their own [s]; 0: the whole record in one where the plant
  /// settles, short ones where it integrates. Infinite: the whole record whatever the plant.
  double segment_s = 0.0;
  /// Of a longer record, pieces with about so many rows together are looked at, spread evenly over it; 0: all of it.
  Eigen::Index most_rows = 0;
};

/// A recording that is not periodic (or is taken as such): simulation errors in time. No floor is known: the noise level is that
/// of the innovations of an autoregressive model of what the base leaves.
///
/// Rows: measured minus simulated output over the root mean square of what the base model, fitted to this record alone, leaves.
/// How states begin: see make_layout (sampled/layout.hpp). A base model with a filter gets the filtered output.
///
/// `known`: one value each of base.known(). Errors, by name: too few samples, other channels than the base has inputs, values
/// that are not finite, an input or output that does not change, a base model that can't be computed.
Expected<std::shared_ptr<const Measurement>> sampled_measurement(const records::Recording& recording, const std::string& name,
                                                                 std::vector<double> known, const BaseModel& base,
                                                                 const SampledOptions& options = {});

}  // namespace bodeflow::residual
