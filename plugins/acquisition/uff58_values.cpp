#include "uff58_values.hpp"

#include <algorithm>
#include <bit>

#include "csv_row.hpp"

namespace bodeflow::acquisition {
namespace {

// Numbers of a binary function that are read at a time.
constexpr std::int64_t kBlock = 1 << 14;

Unexpected<TextError> refuse(std::int64_t line, std::int64_t column, std::string text) {
  return {TextError{line, column, std::move(text)}};
}

Unexpected<TextError> forward(const TextError& e) { return {e}; }

bool is_blank(std::string_view text) { return text.find_first_not_of(" \t") == std::string_view::npos; }

}  // namespace

Uff58Values::Uff58Values(ByteSource& source, const Uff58Function& function)
    : source_(&source), function_(&function), lines_(source) {}

Expected<void, TextError> Uff58Values::start(std::int64_t point) {
  const std::int64_t skipped = std::min(point, function_->points) * function_->numbers_per_point();
  taken_ = 0;
  at_ = 0;
  if (function_->bytes >= 0) {
    bytes_.clear();
    byte_ = 0;
    taken_ = skipped;
    const std::int64_t size = function_->double_precision ? 8 : 4;
    if (auto done = source_->seek(function_->offset + skipped * size); !done) return refuse(0, 0, done.error().text);
    return {};
  }
  if (auto done = lines_.go_to(function_->offset, function_->line); !done) return done;
  while (taken_ < skipped) {
    if (auto value = next(); !value) return forward(value.error());
  }
  return {};
}

Expected<double, TextError> Uff58Values::next() { return function_->bytes < 0 ? next_text() : next_binary(); }

Expected<double, TextError> Uff58Values::next_text() {
  bool begun = taken_ > 0;  // before the first number the line is still one of the header
  while (!begun || is_blank(lines_.line().substr(at_))) {
    const auto more = lines_.next();
    if (!more) return forward(more.error());
    if (!*more || is_uff_mark(lines_.line())) {
      return refuse(lines_.number(), 0,
                    "function ends after " + std::to_string(taken_) + " of " + std::to_string(numbers()) + " values");
    }
    at_ = 0;
    begun = true;
  }
  const std::string_view line = lines_.line();
  const auto value = take_number(line, at_);
  if (!value) {
    const auto end = line.find_first_of(" \t", at_);
    return refuse(lines_.number(), static_cast<std::int64_t>(at_) + 1, shown(line.substr(at_, end - at_)) + " is not a number");
  }
  line_ = lines_.number();
  if (++taken_ == numbers()) {
    if (auto done = check_end(); !done) return forward(done.error());
  }
  return *value;
}

/// After the last value: nothing follows on its line, and the data set ends with the next.
Expected<void, TextError> Uff58Values::check_end() {
  const std::int64_t line = lines_.number();
  const auto wrong = [&](std::int64_t where) {
    return refuse(where, 0, "more values than the " + std::to_string(numbers()) + " that the header states");
  };
  if (!is_blank(lines_.line().substr(at_))) return wrong(line);
  while (true) {
    const auto more = lines_.next();
    if (!more) return forward(more.error());
    if (!*more || is_uff_mark(lines_.line())) return {};
    if (!is_blank(lines_.line())) return wrong(lines_.number());
  }
}

Expected<double, TextError> Uff58Values::next_binary() {
  const std::size_t size = function_->double_precision ? 8 : 4;
  if (byte_ + size > bytes_.size()) {
    const std::int64_t left = numbers() - taken_;
    bytes_.resize(static_cast<std::size_t>(std::min<std::int64_t>(left, kBlock)) * size);
    byte_ = 0;
    for (std::size_t done = 0; done < bytes_.size();) {
      const auto got = source_->read(bytes_.data() + done, bytes_.size() - done);
      if (!got) return refuse(0, 0, got.error().text);
      if (*got == 0) return refuse(0, 0, "changed while it was read");
      done += *got;
    }
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i)
    bits = bits << 8 | static_cast<unsigned char>(bytes_[byte_ + (function_->big_endian ? i : size - 1 - i)]);
  byte_ += size;
  ++taken_;
  return size == 8 ? std::bit_cast<double>(bits) : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
}

}  // namespace bodeflow::acquisition
