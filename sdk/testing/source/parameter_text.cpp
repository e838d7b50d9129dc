#include "parameter_text.hpp"

#include <bodeflow/units.hpp>
#include <cmath>

namespace bodeflow::testing {
namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

std::string unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

/// The entries of "[a, [b, c]]": "a", "[b, c]"; a text without brackets is a list of one. Throws Failure for half of a pair.
std::vector<std::string_view> entries(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && text.front() != '[' && text.back() != ']') return {text};
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') fail("'" + std::string(text) + "' is not a list in brackets");
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

double number(std::string_view text, const char* unit) {
  const auto value = convert(text, unit, true);
  if (!value) fail(value.error().text);
  return *value;
}

std::int64_t integer(std::string_view text) {
  const double value = number(text, "1");
  if (std::floor(value) != value || !(std::abs(value) <= 9e15)) fail("'" + std::string(text) + "' is not an integer");
  return static_cast<std::int64_t>(value);
}

bool boolean(std::string_view text) {
  if (text == "true") return true;
  if (text == "false") return false;
  fail("'" + std::string(text) + "' is neither true nor false");
}

void read_rows(StoredValue& value, std::string_view text) {
  const auto rows = entries(text);
  value.rows = static_cast<std::uint32_t>(rows.size());
  value.columns = value.type == BF_COMPLEX_LIST ? 1 : 0;
  const bool pairs = value.type == BF_COMPLEX_LIST;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (pairs && (rows[i].empty() || rows[i].front() != '[')) {
      value.numbers.insert(value.numbers.end(), {number(rows[i], "1"), 0.0});
      continue;
    }
    const auto cells = entries(rows[i]);
    if (pairs && cells.size() != 2) fail("'" + std::string(rows[i]) + "' is not [re, im]");
    if (!pairs && i == 0) value.columns = static_cast<std::uint32_t>(cells.size());
    if (!pairs && cells.size() != value.columns) fail("rows of a matrix differ in length");
    for (const auto cell : cells) value.numbers.push_back(number(cell, "1"));
  }
}

StoredValue parse(const bf_parameter_descriptor& p, std::string_view text) {
  StoredValue value;
  value.type = p.type;
  value.given = true;
  value.rows = 1;
  switch (p.type) {
    case BF_BOOL:
      value.integer = boolean(text) ? 1 : 0;
      break;
    case BF_INTEGER:
      value.integer = integer(text);
      break;
    case BF_NUMBER:
      value.numbers = {number(text, p.unit)};
      break;
    case BF_NUMBERS:
      for (const auto e : entries(text)) value.numbers.push_back(number(e, p.unit));
      value.rows = static_cast<std::uint32_t>(value.numbers.size());
      break;
    case BF_INTEGERS:
      for (const auto e : entries(text)) value.integers.push_back(integer(e));
      value.rows = static_cast<std::uint32_t>(value.integers.size());
      break;
    case BF_STRINGS:
      for (const auto e : entries(text)) value.strings.push_back(unquoted(e));
      value.rows = static_cast<std::uint32_t>(value.strings.size());
      break;
    case BF_COMPLEX_LIST:
    case BF_MATRIX:
      read_rows(value, text);
      break;
    default:
      value.strings = {unquoted(text)};
  }
  return value;
}

}  // namespace

Expected<StoredValue, Error> parse_parameter(const bf_parameter_descriptor& parameter, std::string_view text) {
  try {
    return parse(parameter, trimmed(text));
  } catch (const Failure& failure) {
    return unexpected(std::string("parameter '") + parameter.name + "': " + failure.what());
  }
}

StoredValue fallback_of(const bf_parameter_descriptor& parameter) {
  StoredValue value;
  value.assign(parameter.fallback);
  value.type = parameter.type;
  value.given = false;
  return value;
}

ValueView::ValueView(const StoredValue& value) {
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

}  // namespace bodeflow::testing
