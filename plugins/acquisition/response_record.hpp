#pragma once

#include <bodeflow/record.hpp>
#include <optional>

#include "response.hpp"

namespace bodeflow::acquisition {

/// How sure an imported response is said to be.
struct ResponseCertainty {
  double relative_deviation = 0.0;  ///< standard deviation of the complex value over its magnitude
  double absolute_deviation = 0.0;  ///< the same in the unit of the response
  std::optional<double> degrees_of_freedom;
  bool stated() const { return relative_deviation > 0.0 || absolute_deviation > 0.0; }
};

/// Gives the response the variance (relative |G|)^2 + absolute^2 at each point. Error: the file has variances.
Expected<void> state_variance(Response& response, const ResponseCertainty& certainty);

/// Gives each element the unit, where the file states none or the same. Errors: a text that is no unit, another unit in the file.
Expected<void> state_unit(Response& response, const std::string& unit);

/// The record `frequency_response` of form `imported`. Without known variances it has no array `variance`; `confidence_radius`
/// and `confidence` stand in it where variances and degrees of freedom are known.
RecordBuilder response_record(const Response& response, const ResponseCertainty& certainty, const std::string& file);

}  // namespace bodeflow::acquisition
