#pragma once

#include <map>

#include "line_reader.hpp"
#include "table.hpp"

namespace bodeflow::acquisition {

/// The header of a CSV text.
struct Header {
  std::vector<Column> columns;
  char separator = ',';
  std::int64_t line = 0;  ///< where it stands
  /// By column: why it can't be read, its name being no UTF-8 text. `columns` has its name with `?` for what is none.
  std::map<std::size_t, TextError> unreadable;
};

/// The first line that is neither empty nor a comment, read as a header. Refused: no such line, no names (numbers instead),
/// names that are empty or repeated.
Expected<Header, TextError> read_header(LineReader& lines);

/// True for a line of blanks alone.
bool is_empty(std::string_view line);

}  // namespace bodeflow::acquisition
