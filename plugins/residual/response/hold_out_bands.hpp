#pragma once

#include "expected.hpp"
#include "records/response.hpp"

namespace bodeflow::residual {

/// A response whose lines are shared out in bands.
struct HeldOutBands {
  records::ResponseData kept;
  records::ResponseData held_out;
};

/// Every `every`-th band of `bands` goes to `held_out`, the first after every / 2 others, so that both ends are kept; the bands
/// are equally wide in the logarithm of the frequency. Neighbouring lines of a measured response err alike: single lines left out
/// would test nothing that their neighbours have not fitted. Lines at 0 Hz are kept. Errors, by name: every < 2, fewer than two
/// bands, a part without lines.
Expected<HeldOutBands> hold_out_bands(const records::ResponseData& response, int bands, int every);

}  // namespace bodeflow::residual
