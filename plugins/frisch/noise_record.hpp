#pragma once

#include <bodeflow/record.hpp>
#include <vector>

#include "band.hpp"
#include "noise_variances.hpp"

namespace bodeflow::frisch {

/// The record `noise_variances` of bands, all with lines, and what the Frisch scheme found in each. Standard deviations of the
/// samples, one a band: `input_first`, `input_second`, `input_pooled` (where all bands have whole periods) and the same of the
/// output; `removed_frequency`, the lines that the second pass left out. For the paper's figures: `frequency` of all lines,
/// `largest_input` and `largest_output` at them, equation (13), and the curves (12) in the plane of the variances,
/// `curve_input` and `curve_output`, lines x points.
RecordBuilder noise_record(const std::vector<Band>& bands, const std::vector<FrischNoise>& found);

}  // namespace bodeflow::frisch
