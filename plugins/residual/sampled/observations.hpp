#pragma once

#include <string>
#include <vector>

#include "records/recording.hpp"

namespace bodeflow::residual {

/// What a recording shows of how it was made, a sentence each: channels that seem clipped, steps of a converter that are coarse
/// beside the signal, an output that stands still while the input moves on (lost samples).
std::vector<std::string> observe(const records::Recording& recording);

}  // namespace bodeflow::residual
