#pragma once

#include <string_view>
#include <vector>

#include "line_reader.hpp"

namespace bodeflow::acquisition {

/// One number of a line and where it begins, counted from one.
struct NumberField {
  double value = 0.0;
  std::int64_t column = 1;
};

/// The refusal of a place in a text file.
Unexpected<TextError> refused_at(std::int64_t line, std::int64_t column, std::string text);

/// "file:line:column: what", without what is not known of the place.
std::string text_at(const std::string& file, const TextError& error);

/// The number that the whole text is: decimal, correctly rounded, whatever the locale. Errors, as words to follow the place: no
/// number, not finite, beyond the range of a double.
Expected<double> number_of(std::string_view text);

/// Writes the numbers of a line to `to`: words between any of `separators`. Errors: those of `number_of`, with the place.
Expected<void, TextError> read_numbers(std::string_view line, std::int64_t number, std::string_view separators,
                                       std::vector<NumberField>& to);

/// The text without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// The text with its ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// "1 point", "3 points".
std::string counted(std::size_t count, const char* noun);

}  // namespace bodeflow::acquisition
