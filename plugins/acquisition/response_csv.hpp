#pragma once

#include "byte_source.hpp"
#include "line_reader.hpp"
#include "response.hpp"

namespace bodeflow::acquisition {

/// The frequency response in a CSV text: the columns that `response_column` knows; the others may hold anything.
///
/// A quantity needs real and imaginary part, or magnitude (absolute, or in dB) and phase (deg or rad, which the header must
/// say). Where both stand, real and imaginary part are read and the others compared with them. `var` is E|dG|^2 of the complex
/// value, `std` its root. Names with two indices (G21) are elements of a matrix, from input u1 to output y2; others are outputs
/// by their own name. Separators, comments, decimal commas and refusals as in open_csv; empty lines between rows are refused.
///
/// `quantities`: as ResponseSelection; columns of others are not read. Errors besides: no frequency column or several, a unit
/// that is none of frequency, angle or variance where one is needed, a part missing or twice, no quantity at all, negative
/// magnitudes or variances, frequencies that do not rise.
Expected<ResponseTable, TextError> read_response_csv(ByteSource& source, const std::vector<std::string>& quantities);

}  // namespace bodeflow::acquisition
