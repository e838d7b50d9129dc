#pragma once

#include <optional>
#include <span>
#include <vector>

#include "line_reader.hpp"
#include "printable.hpp"

namespace bodeflow::acquisition {

/// One field of a line: its text without blanks at the ends and without quotes, and where it begins, counted from one.
struct Field {
  std::string text;
  std::int64_t column = 1;
  bool quoted = false;
};

/// The fields of a line. Quotes as in RFC 4180: a field may stand in "...", a quote inside it is doubled.
/// Errors: a quote that is not closed on its line, or text beside a quoted field.
Expected<std::vector<Field>, TextError> split(std::string_view line, std::int64_t number, char separator);

/// The separator of a table with this header line: the first of `;`, tab, `,` that stands in it outside of quotes; `,` if none
/// does.
char find_separator(std::string_view header);

/// Reads rows of numbers. Locale-free and correctly rounded (std::from_chars).
class RowParser {
 public:
  /// names: of all columns, for messages; slots: per column the place of its value, or -1 for a column that is not read.
  RowParser(char separator, std::vector<std::string> names, std::vector<int> slots);

  /// Writes the values of a row to `values`, by slot. Errors: too few or too many fields, no number, not finite, beyond the
  /// range of a double, decimal commas and points mixed.
  Expected<void, TextError> parse(std::string_view line, std::int64_t number, std::span<double> values);

  /// The text of the field in slot 0 of the row just parsed, as far as it is a number: the time column goes there.
  std::string_view first_slot_text() const { return first_text_; }

  bool decimal_comma() const { return decimal_ == Decimal::comma; }
  bool trailing_separators() const { return trailing_separators_; }

 private:
  enum class Decimal { unknown, point, comma };

  bool parse_plain(std::string_view line, std::span<double> values);
  Expected<void, TextError> parse_any(std::string_view line, std::int64_t number, std::span<double> values);
  Expected<double, TextError> value_of(const Field& field, std::int64_t number, std::size_t position);
  std::optional<std::string> note_decimal(Decimal found, std::int64_t number);

  char separator_;
  std::vector<std::string> names_;
  std::vector<int> slots_;
  Decimal decimal_ = Decimal::unknown;
  std::int64_t decimal_line_ = 0;
  bool trailing_separators_ = false;
  std::string_view first_text_;
  std::string first_owned_;
};

}  // namespace bodeflow::acquisition
