#pragma once

#include <memory>
#include <string>
#include <vector>

#include "records/recording.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// A periodic recording of the inputs of `base` and one output: all bins of the whole-record spectrum from 0 to 1.25 times the
/// last excited line, lines of the period and bins between them, whitened by the noise between the lines.
///
/// `known`: one value each of base.known(). Errors, by name: those of a recording that is not periodic, too short, without noise,
/// without excitation, or with other channels than the base has inputs.
Expected<std::shared_ptr<const Measurement>> periodic_measurement(const records::Recording& recording, const std::string& name,
                                                                  std::vector<double> known, const BaseModel& base);

}  // namespace bodeflow::residual
