#include "number_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "csv_row.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr std::string_view kBlanks = " \t";

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// from_chars takes no plus sign; tables have some.
const char* without_plus(const char* p, const char* end) {
  return end - p > 1 && p[0] == '+' && (is_digit(p[1]) || p[1] == '.') ? p + 1 : p;
}

std::int64_t column_at(std::size_t index) { return static_cast<std::int64_t>(index) + 1; }

}  // namespace

Unexpected<TextError> refused_at(std::int64_t line, std::int64_t column, std::string text) {
  return {TextError{line, column, std::move(text)}};
}

std::string text_at(const std::string& file, const TextError& error) {
  std::string place = file;
  if (error.line > 0) place += ":" + std::to_string(error.line);
  if (error.line > 0 && error.column > 0) place += ":" + std::to_string(error.column);
  return place + ": " + error.text;
}

Expected<double> number_of(std::string_view text) {
  const char* const end = text.data() + text.size();
  double value = 0.0;
  const auto [stop, code] = std::from_chars(without_plus(text.data(), end), end, value);
  if (code == std::errc::result_out_of_range && stop == end) return unexpected(shown(text) + " is beyond the range of a double");
  if (code != std::errc{} || stop != end) return unexpected(shown(text) + " is not a number");
  if (!std::isfinite(value)) return unexpected(shown(text) + " is not finite");
  return value;
}

Expected<void, TextError> read_numbers(std::string_view line, std::int64_t number, std::string_view separators,
                                       std::vector<NumberField>& to) {
  to.clear();
  for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
    const auto value = number_of(line.substr(at, end - at));
    if (!value) return refused_at(number, column_at(at), value.error().text);
    to.push_back({*value, column_at(at)});
    at = line.find_first_not_of(separators, end);
  }
  return {};
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return lower;
}

std::string counted(std::size_t count, const char* noun) { return std::to_string(count) + " " + noun + (count == 1 ? "" : "s"); }

}  // namespace bodeflow::acquisition
