#pragma once

#include "byte_source.hpp"
#include "line_reader.hpp"
#include "response.hpp"

namespace bodeflow::acquisition {

/// The frequency response functions in a universal file: every data set 58 or 58b of function type 4, each from its reference
/// (input) to its response (output), both named by node and direction: "12+Z".
///
/// The ordinate is complex, single or double, the abscissa frequency, even or not; all functions have the same frequencies. The
/// unit comes from the labels of records 9 and 10 (the `g` of an acceleration is the standard gravity, gn). Other data sets and
/// other functions are passed over, and told. Refused: what read_uff58 and Uff58Values refuse, a file without such a function,
/// real ordinates, another abscissa, values that are not finite, functions with other frequencies than the first.
Expected<ResponseTable, TextError> read_uff_response(ByteSource& source);

}  // namespace bodeflow::acquisition
