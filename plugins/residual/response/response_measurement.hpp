#pragma once

#include <memory>
#include <string>
#include <vector>

#include "records/response.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// A measured frequency response. Where it states a variance the floor is known; else errors count relative to the magnitude (in
/// %), and the floor is unknown.
///
/// `known`: one value each of base.known(). Errors, by name: other inputs than the base has, several outputs, too few lines, a
/// response of 0.
Expected<std::shared_ptr<const Measurement>> response_measurement(const records::ResponseData& response, const std::string& name,
                                                                  std::vector<double> known, const BaseModel& base);

}  // namespace bodeflow::residual
