#include "response_header.hpp"

#include <array>

#include "number_line.hpp"
#include "table.hpp"

namespace bodeflow::acquisition {
namespace {

struct Prefix {
  std::string_view word;
  ResponsePart part;
};
// A word stands before those that it begins with.
constexpr std::array<Prefix, 14> kPrefixes = {{{"real", ResponsePart::real},
                                               {"re", ResponsePart::real},
                                               {"imag", ResponsePart::imaginary},
                                               {"im", ResponsePart::imaginary},
                                               {"magnitude", ResponsePart::magnitude},
                                               {"mag", ResponsePart::magnitude},
                                               {"abs", ResponsePart::magnitude},
                                               {"db", ResponsePart::magnitude},
                                               {"phase", ResponsePart::phase},
                                               {"angle", ResponsePart::phase},
                                               {"arg", ResponsePart::phase},
                                               {"var", ResponsePart::variance},
                                               {"std", ResponsePart::deviation},
                                               {"variance", ResponsePart::variance}}};

bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return is_capital(c) || (c >= 'a' && c <= 'z'); }

/// Name and unit of a header; `omega_rad_s` beside what every table has.
Column name_and_unit(std::string_view header) {
  Column column = parse_header(header);
  const std::string_view name = trimmed(header);
  constexpr std::string_view kRadians = "_rad_s";
  if (name.size() > kRadians.size() && name.substr(name.size() - kRadians.size()) == kRadians) {
    column.name = name.substr(0, name.size() - kRadians.size());
    column.unit = "rad/s";
  }
  return column;
}

/// What stands behind a prefix, if it can be a quantity: "(X)", "_X", " X" or "X" in capitals; "G" for nothing.
std::optional<std::string> quantity_behind(std::string_view rest) {
  if (rest.empty()) return "G";
  if (rest.front() == '(' && rest.back() == ')' && rest.size() > 2) {
    const std::string_view inside = trimmed(rest.substr(1, rest.size() - 2));
    return inside.empty() ? std::nullopt : std::optional<std::string>(inside);
  }
  if (rest.front() == '_' || rest.front() == ' ') {
    const std::string_view behind = trimmed(rest.substr(1));
    return behind.empty() ? std::nullopt : std::optional<std::string>(behind);
  }
  return is_capital(rest.front()) ? std::optional<std::string>(rest) : std::nullopt;
}

}  // namespace

std::optional<ResponseColumn> response_column(std::string_view header) {
  const Column column = name_and_unit(header);
  const std::string_view name = column.name;
  const std::string lower = lower_case(name);
  if (lower == "f" || lower == "freq" || lower == "frequency")
    return ResponseColumn{ResponsePart::frequency, "", column.unit.empty() ? "Hz" : column.unit};
  if (lower == "w" || lower == "omega")
    return ResponseColumn{ResponsePart::frequency, "", column.unit.empty() ? "rad/s" : column.unit};
  if (name.size() > 2 && name.front() == '|' && name.back() == '|')
    return ResponseColumn{ResponsePart::magnitude, std::string(trimmed(name.substr(1, name.size() - 2))), column.unit};
  for (const Prefix& prefix : kPrefixes) {
    if (lower.compare(0, prefix.word.size(), prefix.word) != 0) continue;
    auto quantity = quantity_behind(name.substr(prefix.word.size()));
    if (!quantity) continue;
    return ResponseColumn{prefix.part, std::move(*quantity), prefix.word == "db" ? "dB" : column.unit};
  }
  return std::nullopt;
}

std::optional<MatrixPlace> matrix_place(std::string_view quantity) {
  std::size_t at = 0;
  while (at < quantity.size() && is_letter(quantity[at])) ++at;
  MatrixPlace place{std::string(quantity.substr(0, at)), "", ""};
  std::string_view rest = quantity.substr(at);
  if (at == 0 || rest.empty()) return std::nullopt;
  if (rest.size() == 2 && is_digit(rest[0]) && is_digit(rest[1])) {
    place.output = rest.substr(0, 1);
    place.input = rest.substr(1);
  } else {
    if (rest.front() == '(' && rest.back() == ')')
      rest = rest.substr(1, rest.size() - 2);
    else if (rest.front() == '_')
      rest.remove_prefix(1);
    const std::size_t middle = rest.find_first_of(",_");
    if (middle == std::string_view::npos) return std::nullopt;
    place.output = trimmed(rest.substr(0, middle));
    place.input = trimmed(rest.substr(middle + 1));
  }
  for (const std::string* index : {&place.output, &place.input}) {
    if (index->empty() || index->size() > 4 || index->find_first_not_of("0123456789") != std::string::npos ||
        index->front() == '0')
      return std::nullopt;
  }
  return place;
}

}  // namespace bodeflow::acquisition
