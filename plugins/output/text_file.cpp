#include "text_file.hpp"

#include <cerrno>
#include <charconv>
#include <system_error>

namespace bodeflow::output {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 16;

}  // namespace

Unexpected<Error> TextFile::refuse(int number) const {
  return unexpected(path_ + ": " + std::generic_category().message(number));
}

Expected<TextFile> TextFile::create(const std::string& path) {
  TextFile made;
  made.path_ = path;
  made.file_.reset(std::fopen(path.c_str(), "wb"));
  if (!made.file_) return made.refuse(errno);
  std::setvbuf(made.file_.get(), nullptr, _IONBF, 0);
  made.buffer_.reserve(2 * kBuffer);
  return made;
}

Expected<void> TextFile::write(std::string_view text) {
  buffer_ += text;
  return buffer_.size() < kBuffer ? Expected<void>() : flush();
}

Expected<void> TextFile::flush() {
  const std::size_t size = buffer_.size();
  const bool whole = std::fwrite(buffer_.data(), 1, size, file_.get()) == size;
  buffer_.clear();
  if (!whole) return refuse(errno);
  return {};
}

Expected<void> TextFile::close() {
  if (!file_) return {};
  auto flushed = flush();
  if (std::fclose(file_.release()) != 0 && flushed) return refuse(errno);
  return flushed;
}

void append_number(std::string& text, double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  text.append(digits, end);
}

void append_decimal(std::string& text, double value) {
  char digits[400];  // the longest double has 309 digits before the point, or some 340 after it
  const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed).ptr;
  text.append(digits, end);
}

}  // namespace bodeflow::output
