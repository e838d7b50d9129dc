#pragma once

#include <bodeflow/record.hpp>
#include <optional>
#include <string>
#include <vector>

#include "spectra.hpp"

namespace bodeflow::maximum_likelihood {

/// What was read from a record `frequency_response`.
struct Measured {
  Spectra spectra;
  bool has_variance = false;  ///< false: the variances of `spectra` are 0
  bool mean_spectra = false;  ///< true: with the noise of the input and its covariance with that of the output
  std::string input_name;
  std::vector<std::string> output_names;
  std::vector<std::string> units;         ///< of G, one an output
  std::string input_unit, output_unit;    ///< where the record tells them; output_unit: of the first output
  std::optional<double> input_amplitude;  ///< largest |input|
  std::string checksum;
};

/// One input and the named outputs of a record, with mean spectra and full covariance where the record has them (one input, form
/// errors_in_variables or reference), else with the response and its variance.
/// input: name, or empty for the only one; outputs: names, in this order, or empty for all.
/// Errors: those of records::read_response; names that the record does not have (with those that it has); several inputs and no
/// name.
Expected<Measured> read_measured(const RecordView& record, const std::string& input, const std::vector<std::string>& outputs);

}  // namespace bodeflow::maximum_likelihood
