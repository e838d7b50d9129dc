#include "csv_row.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace bodeflow::acquisition {
namespace {

Unexpected<TextError> refuse(std::int64_t line, std::int64_t column, std::string text) {
  return {TextError{line, column, std::move(text)}};
}

bool is_blank(char c, char separator) { return c == ' ' || (c == '\t' && separator != '\t'); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// from_chars takes no plus sign; tables have some.
const char* without_plus(const char* p, const char* end) {
  return end - p > 1 && p[0] == '+' && (is_digit(p[1]) || p[1] == '.') ? p + 1 : p;
}

}  // namespace

char find_separator(std::string_view header) {
  for (const char candidate : {';', '\t', ','}) {
    bool quoted = false;
    for (const char c : header) {
      if (c == '"') quoted = !quoted;
      if (c == candidate && !quoted) return candidate;
    }
  }
  return ',';
}

Expected<std::vector<Field>, TextError> split(std::string_view line, std::int64_t number, char separator) {
  std::vector<Field> fields;
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && is_blank(line[at], separator)) ++at;
    Field field;
    field.column = static_cast<std::int64_t>(at) + 1;
    if (at < line.size() && line[at] == '"') {
      field.quoted = true;
      for (++at;; ++at) {
        if (at >= line.size()) return refuse(number, field.column, "quote opened here is not closed on its line");
        if (line[at] != '"') {
          field.text += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
          field.text += line[at++];
        } else {
          break;
        }
      }
      ++at;
      while (at < line.size() && is_blank(line[at], separator)) ++at;
      if (at < line.size() && line[at] != separator) {
        return refuse(number, static_cast<std::int64_t>(at) + 1, "text after a closing quote");
      }
    } else {
      const std::size_t end = std::min(line.find(separator, at), line.size());
      std::size_t last = end;
      while (last > at && is_blank(line[last - 1], separator)) --last;
      field.text = line.substr(at, last - at);
      at = end;
    }
    fields.push_back(std::move(field));
    if (at >= line.size()) return fields;
    ++at;
  }
}

RowParser::RowParser(char separator, std::vector<std::string> names, std::vector<int> slots)
    : separator_(separator), names_(std::move(names)), slots_(std::move(slots)) {}

Expected<void, TextError> RowParser::parse(std::string_view line, std::int64_t number, std::span<double> values) {
  if (decimal_ != Decimal::comma && parse_plain(line, values)) return {};
  return parse_any(line, number, values);
}

/// The usual row, without a copy: false, with nothing decided, for a row that needs a closer look.
bool RowParser::parse_plain(std::string_view line, std::span<double> values) {
  const char* p = line.data();
  const char* const end = p + line.size();
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (i != 0) {
      if (p == end) return false;
      ++p;  // the separator
    }
    if (slots_[i] < 0) {
      const auto* next =
          p == end ? nullptr : static_cast<const char*>(std::memchr(p, separator_, static_cast<std::size_t>(end - p)));
      const char* stop = next == nullptr ? end : next;
      if (std::find(p, stop, '"') != stop) return false;
      p = stop;
      continue;
    }
    while (p != end && is_blank(*p, separator_)) ++p;
    p = without_plus(p, end);
    double value = 0.0;
    const auto [stop, code] = std::from_chars(p, end, value);
    if (code != std::errc{} || !std::isfinite(value)) return false;
    if (decimal_ == Decimal::unknown && separator_ != ',' && std::find(p, stop, '.') != stop) return false;
    if (slots_[i] == 0) first_text_ = {p, static_cast<std::size_t>(stop - p)};
    p = stop;
    while (p != end && is_blank(*p, separator_)) ++p;
    if (p != end && *p != separator_) return false;
    values[static_cast<std::size_t>(slots_[i])] = value;
  }
  return p == end;
}

Expected<void, TextError> RowParser::parse_any(std::string_view line, std::int64_t number, std::span<double> values) {
  auto fields = split(line, number, separator_);
  if (!fields) return {Unexpected<TextError>{fields.error()}};
  if (fields->size() == slots_.size() + 1 && fields->back().text.empty() && !fields->back().quoted) {
    fields->pop_back();
    trailing_separators_ = true;
  }
  if (fields->size() != slots_.size()) {
    const std::int64_t at =
        fields->size() > slots_.size() ? (*fields)[slots_.size()].column : static_cast<std::int64_t>(line.size()) + 1;
    return refuse(number, at,
                  std::to_string(fields->size()) + (fields->size() == 1 ? " field" : " fields") + "; the header has " +
                      std::to_string(slots_.size()));
  }
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i] < 0) continue;
    const auto value = value_of((*fields)[i], number, i);
    if (!value) return {Unexpected<TextError>{value.error()}};
    values[static_cast<std::size_t>(slots_[i])] = *value;
  }
  return {};
}

/// Why a decimal sign can't stand here, or nothing.
std::optional<std::string> RowParser::note_decimal(Decimal found, std::int64_t number) {
  if (decimal_ == Decimal::unknown) {
    decimal_ = found;
    decimal_line_ = number;
  }
  if (decimal_ == found) return std::nullopt;
  return std::string(found == Decimal::comma ? "decimal comma, but a decimal point" : "decimal point, but a decimal comma") +
         " in line " + std::to_string(decimal_line_);
}

Expected<double, TextError> RowParser::value_of(const Field& field, std::int64_t number, std::size_t position) {
  const auto wrong = [&](const std::string& what) -> Expected<double, TextError> {
    return refuse(number, field.column, "column '" + names_[position] + "': " + what);
  };
  if (field.text.empty()) return wrong("value missing");
  std::string text = field.text;
  if (separator_ != ',') {
    const auto commas = std::count(text.begin(), text.end(), ',');
    const auto points = std::count(text.begin(), text.end(), '.');
    if (commas > 0 && points > 0) return wrong(shown(text) + " is no number: grouped digits are not read");
    if (commas == 1) std::replace(text.begin(), text.end(), ',', '.');
    if (commas == 1 || points == 1) {
      if (const auto why = note_decimal(commas == 1 ? Decimal::comma : Decimal::point, number))
        return wrong(shown(field.text) + ": " + *why);
    }
  }
  const char* const end = text.data() + text.size();
  const char* const begin = without_plus(text.data(), end);
  double value = 0.0;
  const auto [stop, code] = std::from_chars(begin, end, value);
  if (code == std::errc::result_out_of_range && stop == end) return wrong(shown(field.text) + " is beyond the range of a double");
  if (code != std::errc{} || stop != end) return wrong(shown(field.text) + " is not a number");
  if (!std::isfinite(value)) return wrong(shown(field.text) + " is not finite");
  if (slots_[position] == 0) {
    first_owned_.assign(begin, end);
    first_text_ = first_owned_;
  }
  return value;
}

}  // namespace bodeflow::acquisition
