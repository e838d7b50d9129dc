#pragma once

#include "line_reader.hpp"
#include "table.hpp"

namespace bodeflow::acquisition {

/// The header of a CSV text.
struct Header {
  std::vector<Column> columns;
  char separator = ',';
  std::int64_t line = 0;  ///< where it stands
};

/// The first line that is neither empty nor a comment, read as a header. Refused: no such line, no names (numbers instead),
/// names that are empty, repeated or no UTF-8 text.
Expected<Header, TextError> read_header(LineReader& lines);

/// True for a line of blanks alone.
bool is_empty(std::string_view line);

}  // namespace bodeflow::acquisition
