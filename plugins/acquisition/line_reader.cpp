#include "line_reader.hpp"

#include <cstring>

namespace bodeflow::acquisition {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 18;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

Unexpected<TextError> refuse(std::int64_t line, std::int64_t column, std::string text) {
  return {TextError{line, column, std::move(text)}};
}

}  // namespace

LineReader::LineReader(ByteSource& source) : source_(&source), buffer_(kBuffer) {}

Expected<void, TextError> LineReader::go_to(std::int64_t offset, std::int64_t number) {
  if (auto done = source_->seek(offset); !done) return refuse(0, 0, done.error().text);
  begin_ = end_ = 0;
  source_offset_ = offset;
  at_end_ = false;
  number_ = number - 1;
  return {};
}

/// More bytes behind those that wait; false at the end of the source.
Expected<bool, TextError> LineReader::fill() {
  if (begin_ != 0) std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  if (end_ == buffer_.size()) {
    if (end_ > kLongest) return refuse(number_ + 1, 0, "line longer than 1 MiB: is this a table of text?");
    buffer_.resize(buffer_.size() * 2);
  }
  const auto got = source_->read(buffer_.data() + end_, buffer_.size() - end_);
  if (!got) return refuse(0, 0, got.error().text);
  end_ += *got;
  source_offset_ += static_cast<std::int64_t>(*got);
  at_end_ = *got == 0;
  return !at_end_;
}

Expected<bool, TextError> LineReader::take(std::size_t length, std::size_t with_end) {
  ++number_;
  line_ = {buffer_.data() + begin_, length};
  begin_ += with_end;
  if (number_ == 1) {
    if (line_.substr(0, 2) == "\xFF\xFE" || line_.substr(0, 2) == "\xFE\xFF") {
      return refuse(1, 1, "UTF-16 text; save the file as UTF-8");
    }
    if (line_.substr(0, 3) == kByteOrderMark) line_.remove_prefix(3);
  }
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  if (line_.size() > kLongest) return refuse(number_, 0, "line longer than 1 MiB: is this a table of text?");
  const auto column = [this](const void* at) { return static_cast<const char*>(at) - line_.data() + 1; };
  if (line_.empty()) return true;
  if (const void* at = std::memchr(line_.data(), '\0', line_.size())) {
    return refuse(number_, column(at), "NUL byte: this is no text, or the file is damaged");
  }
  if (const void* at = std::memchr(line_.data(), '\r', line_.size())) {
    return refuse(number_, column(at), "carriage return inside a line; lines end with LF or CRLF");
  }
  return true;
}

Expected<bool, TextError> LineReader::next() {
  std::size_t looked = 0;
  while (true) {
    const char* start = buffer_.data() + begin_;
    const std::size_t waiting = end_ - begin_;
    if (const void* found = waiting == looked ? nullptr : std::memchr(start + looked, '\n', waiting - looked)) {
      const auto length = static_cast<std::size_t>(static_cast<const char*>(found) - start);
      return take(length, length + 1);
    }
    looked = waiting;
    if (at_end_) return waiting == 0 ? Expected<bool, TextError>(false) : take(waiting, waiting);
    if (auto more = fill(); !more) return more;
  }
}

}  // namespace bodeflow::acquisition
