#pragma once

#include <memory>
#include <string>
#include <vector>

#include "records/recording.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// A recording that is not periodic (or is taken as such): simulation errors in time. No floor is known: the noise level is that
/// of the innovations of an autoregressive model of what the base leaves.
///
/// `known`: one value each of base.known(). Errors, by name: too few samples, other channels than the base has inputs.
Expected<std::shared_ptr<const Measurement>> sampled_measurement(const records::Recording& recording, const std::string& name,
                                                                 std::vector<double> known, const BaseModel& base);

}  // namespace bodeflow::residual
