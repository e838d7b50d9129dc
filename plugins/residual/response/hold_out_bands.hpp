#pragma once

#include "expected.hpp"
#include "records/response.hpp"

namespace bodeflow::residual {

/// A response whose lines are shared out in bands.
struct HeldOutBands {
  records::ResponseData kept;
  records::ResponseData held_out;
};

/// Every `every`-th band of so many octaves goes to `held_out`, the first after every / 2 others. Neighbouring lines of a
/// measured response err alike: single lines left out would test nothing that their neighbours have not fitted. Lines at 0 Hz are
/// kept. Errors, by name: octaves that are not above 0, every < 2, a part without lines.
Expected<HeldOutBands> hold_out_bands(const records::ResponseData& response, double octaves, int every);

}  // namespace bodeflow::residual
