#pragma once

#include <bodeflow/record.hpp>
#include <string>
#include <vector>

#include "local_polynomial.hpp"
#include "records.hpp"

namespace bodeflow::spectrum {

/// What a local polynomial estimate was made from.
struct LocalPolynomialOrigin {
  LocalPolynomial settings;
  Signals references, inputs, outputs;  ///< no references: known input
  double sample_rate_hz = 1.0;
  std::int64_t samples = 0;
  std::int64_t step = 1;                ///< from line to line of the estimate
  std::vector<double> input_amplitude;  ///< largest |u|, one an input
  std::vector<std::string> warnings;    ///< what the record says of them
};

/// What spoils the estimate, each with what to do, behind the warnings that stand already: lines without excitation, resonances
/// narrower than a fit, an input that stands little above its noise.
std::vector<std::string> local_polynomial_warnings(const LocalPolynomialEstimate& estimate, const LocalPolynomialOrigin& from);

/// The record `frequency_response` of the estimate, with noise and transient levels.
RecordBuilder local_polynomial_record(const LocalPolynomialEstimate& estimate, const LocalPolynomialOrigin& from);

}  // namespace bodeflow::spectrum
