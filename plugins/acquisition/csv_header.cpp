#include "csv_header.hpp"

#include <algorithm>
#include <bodeflow/utf8.hpp>
#include <charconv>
#include <map>

#include "csv_row.hpp"

namespace bodeflow::acquisition {
namespace {

Unexpected<TextError> refuse(std::int64_t line, std::int64_t column, std::string text) {
  return {TextError{line, column, std::move(text)}};
}

bool is_number(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  const char* const end = text.data() + text.size();
  const char* const begin = text.size() > 1 && text.front() == '+' ? text.data() + 1 : text.data();
  double value = 0.0;
  const auto result = std::from_chars(begin, end, value);
  return result.ec != std::errc::invalid_argument && result.ptr == end && text.find_first_of("0123456789") != std::string::npos;
}

Expected<void, TextError> check_names(const std::vector<Field>& fields, std::int64_t line) {
  if (std::any_of(fields.begin(), fields.end(), [](const Field& f) { return !f.quoted && is_number(f.text); })) {
    return refuse(line, 1,
                  "no header: the first line holds numbers; begin the file with a line of names, such as 't [s],u [V],y [rad]'");
  }
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const Field& f = fields[i];
    if (f.text.empty()) return refuse(line, f.column, "column " + std::to_string(i + 1) + " has no name");
    if (!is_text(f.text)) continue;
    const auto [before, fresh] = seen.emplace(printable(f.text), i + 1);
    if (!fresh) {
      return refuse(line, f.column,
                    "column name " + shown(f.text) + " stands twice: columns " + std::to_string(before->second) + " and " +
                        std::to_string(i + 1));
    }
  }
  return {};
}

}  // namespace

bool is_empty(std::string_view line) { return line.find_first_not_of(" \t") == std::string_view::npos; }

Expected<Header, TextError> read_header(LineReader& lines) {
  do {
    const auto more = lines.next();
    if (!more) return {Unexpected<TextError>{more.error()}};
    if (!*more) return refuse(0, 0, lines.number() == 0 ? "empty file" : "no header: only empty lines and comments");
  } while (is_empty(lines.line()) || lines.line().front() == '#');

  Header header;
  header.line = lines.number();
  header.separator = find_separator(lines.line());
  auto fields = split(lines.line(), header.line, header.separator);
  if (!fields) return {Unexpected<TextError>{fields.error()}};
  if (fields->size() > 1 && fields->back().text.empty() && !fields->back().quoted) fields->pop_back();
  if (auto done = check_names(*fields, header.line); !done) return {Unexpected<TextError>{done.error()}};
  for (const Field& f : *fields) {
    header.columns.push_back(parse_header(printable(f.text)));
    const std::size_t number = header.columns.size();
    if (is_text(f.text)) continue;
    header.unreadable[number - 1] = {
        header.line, f.column,
        "the name of column " + std::to_string(number) + ", " + shown(f.text) + ", is not UTF-8 text; save the file as UTF-8"};
  }
  return header;
}

}  // namespace bodeflow::acquisition
