#pragma once

#include "expected.hpp"
#include "model/joint_model.hpp"
#include "records/response.hpp"

namespace bodeflow::residual {

/// The response as `base` can be compared with it: in the unit that base.response_unit() asks for, without a line at frequency 0.
/// Errors, by name: those of response_measurement.
Expected<records::ResponseData> checked_response(records::ResponseData response, const BaseModel& base);

}  // namespace bodeflow::residual
