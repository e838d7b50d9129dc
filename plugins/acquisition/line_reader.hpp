#pragma once

#include <cstdint>
#include <vector>

#include "byte_source.hpp"

namespace bodeflow::acquisition {

/// A place in a text file and what is wrong there; column 0: the whole line, line 0: the whole file.
struct TextError {
  std::int64_t line = 0;
  std::int64_t column = 0;
  std::string text;
};

/// The lines of a text, in bounded memory: LF or CRLF, a UTF-8 byte order mark at the start passed over.
class LineReader {
 public:
  /// Longer lines are refused: no table has them, a file that is no text has.
  static constexpr std::size_t kLongest = std::size_t{1} << 20;

  explicit LineReader(ByteSource& source);

  /// Goes to the next line: false at the end. Refused: NUL bytes, a carriage return inside a line, UTF-16, longer lines.
  Expected<bool, TextError> next();

  /// The line without its end; valid until `next`.
  std::string_view line() const { return line_; }
  /// Counted from one.
  std::int64_t number() const { return number_; }

  /// The byte at which the next line begins.
  std::int64_t offset() const { return source_offset_ - static_cast<std::int64_t>(end_ - begin_); }

  /// To the line that begins at this byte and has this number: the first by default.
  Expected<void, TextError> go_to(std::int64_t offset = 0, std::int64_t number = 1);

 private:
  Expected<bool, TextError> fill();
  Expected<bool, TextError> take(std::size_t length, std::size_t with_end);

  ByteSource* source_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
  std::int64_t source_offset_ = 0;  // of the byte behind those in the buffer
  bool at_end_ = false;
  std::string_view line_;
  std::int64_t number_ = 0;
};

}  // namespace bodeflow::acquisition
