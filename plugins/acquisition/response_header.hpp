#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace bodeflow::acquisition {

/// What a column of a frequency response table holds.
enum class ResponsePart { frequency, real, imaginary, magnitude, phase, variance, deviation };

/// The meaning of a column's header.
struct ResponseColumn {
  ResponsePart part = ResponsePart::frequency;
  std::string quantity;  ///< "G11", "Z"; "G" where the header names none; "" for the frequency
  std::string unit;      ///< as written; "" where none is
};

/// The meaning of a header, or nothing for a column that is no part of a response.
///
/// Frequency: `f`, `freq`, `frequency`, `omega`, `w`. Parts of a quantity X: `re`, `real`, `im`, `imag`; `abs`, `mag`,
/// `magnitude`, `db`; `phase`, `angle`, `arg`; `var` and `std` (of the complex value), written `re(X)`, `re_X`, `re X` or, with X
/// in capitals, `reX`; alone they belong to G. `|X|` is a magnitude. All in any case. The unit stands behind: `[ohm]`, `(ohm)`
/// or `_ohm`; `db(X)` is a magnitude in dB.
std::optional<ResponseColumn> response_column(std::string_view header);

/// Where "G21", "G_2_1", "G(2,1)" stands in a matrix: output 2, input 1. Nothing for a name without two indices.
struct MatrixPlace {
  std::string letters;
  std::string output, input;  ///< "2", "1"
};
std::optional<MatrixPlace> matrix_place(std::string_view quantity);

}  // namespace bodeflow::acquisition
