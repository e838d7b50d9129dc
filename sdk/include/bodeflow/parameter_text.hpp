#pragma once

#include <bodeflow/parameter_types.hpp>
#include <bodeflow/units.hpp>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

/// Values of parameters as people write them: "2.5", "10 kHz", "[1, 2]".
namespace bodeflow {
namespace detail {

/// Reads one value. Everything throws Failure with what was found and what is allowed.
class ValueReader {
 public:
  ValueReader(std::uint32_t type, const char* unit) : unit_(unit) { value_.type = type; }

  StoredValue read(std::string_view text) {
    text = trimmed(text);
    value_.given = true;
    value_.rows = 1;
    switch (value_.type) {
      case BF_BOOL:
        value_.integer = boolean(text) ? 1 : 0;
        break;
      case BF_INTEGER:
        value_.integer = integer(text);
        break;
      case BF_NUMBER:
        value_.numbers = {number(text, unit_)};
        break;
      case BF_NUMBERS:
        for (const auto e : entries(text)) value_.numbers.push_back(number(e, unit_));
        value_.rows = static_cast<std::uint32_t>(value_.numbers.size());
        break;
      case BF_INTEGERS:
        for (const auto e : entries(text)) value_.integers.push_back(integer(e));
        value_.rows = static_cast<std::uint32_t>(value_.integers.size());
        break;
      case BF_STRINGS:
        for (const auto e : entries(text)) value_.strings.push_back(unquoted(e));
        value_.rows = static_cast<std::uint32_t>(value_.strings.size());
        break;
      case BF_COMPLEX_LIST:
      case BF_MATRIX:
        rows(text);
        break;
      default:
        value_.strings = {unquoted(text)};
    }
    return std::move(value_);
  }

 private:
  static std::string unquoted(std::string_view text) {
    text = trimmed(text);
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
    return std::string(text);
  }

  /// The entries of "[a, [b, c]]": "a", "[b, c]"; a text without brackets is a list of one.
  static std::vector<std::string_view> entries(std::string_view text) {
    text = trimmed(text);
    if (!text.empty() && text.front() != '[' && text.back() != ']') return {text};
    if (text.size() < 2 || text.front() != '[' || text.back() != ']')
      fail("'" + std::string(text) + "' is not a list in brackets");
    text = text.substr(1, text.size() - 2);
    std::vector<std::string_view> list;
    int depth = 0;
    bool quoted = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= text.size(); ++i) {
      if (i == text.size() || (text[i] == ',' && depth == 0 && !quoted)) {
        list.push_back(trimmed(text.substr(begin, i - begin)));
        begin = i + 1;
      } else if (text[i] == '"') {
        quoted = !quoted;
      } else if (!quoted) {
        depth += text[i] == '[' ? 1 : text[i] == ']' ? -1 : 0;
      }
    }
    if (list.size() == 1 && list[0].empty()) list.clear();
    return list;
  }

  static double number(std::string_view text, const char* unit) {
    const auto value = convert(text, unit, true);
    if (!value) fail(value.error().text);
    return *value;
  }

  static std::int64_t integer(std::string_view text) {
    const double value = number(text, "1");
    if (std::floor(value) != value || !(std::abs(value) <= 9e15)) fail("'" + std::string(text) + "' is not an integer");
    return static_cast<std::int64_t>(value);
  }

  static bool boolean(std::string_view text) {
    if (text == "true") return true;
    if (text == "false") return false;
    fail("'" + std::string(text) + "' is neither true nor false");
  }

  void rows(std::string_view text) {
    const auto list = entries(text);
    const bool pairs = value_.type == BF_COMPLEX_LIST;
    value_.rows = static_cast<std::uint32_t>(list.size());
    value_.columns = pairs ? 1 : 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (pairs && (list[i].empty() || list[i].front() != '[')) {
        value_.numbers.insert(value_.numbers.end(), {number(list[i], "1"), 0.0});
        continue;
      }
      const auto cells = entries(list[i]);
      if (pairs && cells.size() != 2) fail("'" + std::string(list[i]) + "' is not [re, im]");
      if (!pairs && i == 0) value_.columns = static_cast<std::uint32_t>(cells.size());
      if (!pairs && cells.size() != value_.columns) fail("rows of a matrix differ in length");
      for (const auto cell : cells) value_.numbers.push_back(number(cell, "1"));
    }
  }

  const char* unit_;
  StoredValue value_;
};

}  // namespace detail

inline namespace v0 {

/// The value of a parameter of that type and unit from its text: "2.5", "10 kHz", "true", "[1, 2]", "[[1, 2], [3, 4]]" (matrix,
/// or complex pairs), any word or "quoted text". Range and choices are not looked at. Error: why it is none.
inline Expected<StoredValue, Error> parse_value(std::uint32_t type, const char* unit, std::string_view text) {
  try {
    return detail::ValueReader(type, unit == nullptr ? "" : unit).read(text);
  } catch (const Failure& failure) {
    return unexpected(failure.what());
  }
}

/// A value as the ABI takes it; borrows from the value, which lives unchanged at least as long.
class BorrowedValue {
 public:
  explicit BorrowedValue(const StoredValue& value) {
    for (const std::string& s : value.strings) strings_.push_back(s.c_str());
    c_.struct_size = sizeof c_;
    c_.type = value.type;
    c_.given = value.given ? 1 : 0;
    c_.rows = value.rows;
    c_.columns = value.columns;
    c_.integer = value.integer;
    c_.numbers = value.numbers.data();
    c_.integers = value.integers.data();
    c_.strings = strings_.data();
  }
  const bf_parameter_value& c() const { return c_; }

 private:
  std::vector<const char*> strings_;
  bf_parameter_value c_{};
};

}  // namespace v0
}  // namespace bodeflow
