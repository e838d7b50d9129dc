#include <algorithm>
#include <bodeflow/units.hpp>
#include <cmath>

#include "table.hpp"

namespace bodeflow::acquisition {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return text;
}

// Longer texts are no unit, whatever they say.
constexpr std::size_t kLongestUnit = 64;

/// In `name_unit`: `u_1` numbers a signal, and `x_min`, `x_var` name a least value and a variance, no minutes and no reactive
/// power.
bool is_unit_suffix(std::string_view text) {
  return is_unit(text) && !(text.front() >= '0' && text.front() <= '9') && text != "min" && text != "var";
}

// More names than these are not listed in a message.
constexpr std::size_t kMostNames = 30;

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > kMostNames) text += " and " + std::to_string(names.size() - kMostNames) + " more";
  return text;
}

/// Why the leftover of that name is no column, or nothing.
const Leftover* find_leftover(const std::vector<Leftover>& leftovers, const std::string& name) {
  const auto found = std::find_if(leftovers.begin(), leftovers.end(), [&](const Leftover& l) { return l.name == name; });
  return found == leftovers.end() ? nullptr : &*found;
}

}  // namespace

bool is_unit(std::string_view text) { return !text.empty() && text.size() <= kLongestUnit && is_known_unit(text); }

Column parse_header(std::string_view text) {
  text = trimmed(text);
  Column column;
  column.header = column.name = text;
  const std::size_t square = text.rfind('['), round = text.rfind(" ("), line = text.rfind('_');
  const auto ends_with = [&](char last) { return !text.empty() && text.back() == last; };
  std::string_view name, unit;
  bool known = false;
  if ((ends_with(']') && square != std::string_view::npos) || (ends_with(')') && round != std::string_view::npos)) {
    const std::size_t open = ends_with(']') ? square : round + 1;
    name = trimmed(text.substr(0, open));
    unit = trimmed(text.substr(open + 1, text.size() - open - 2));
    known = is_unit(unit);
  } else if (line != std::string_view::npos) {
    name = text.substr(0, line);
    unit = text.substr(line + 1);
    known = is_unit_suffix(unit);
  }
  if (!name.empty() && known) {
    column.name = name;
    column.unit = unit;
  }
  return column;
}

Expected<std::size_t> find_column(const std::vector<Column>& columns, const std::string& name,
                                  const std::vector<Leftover>& leftovers) {
  const std::string wanted(trimmed(name));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Column& c = columns[i];
    if (c.header == wanted) return i;
    if (c.name == wanted || (!c.unit.empty() && (wanted == c.name + "_" + c.unit || wanted == c.name + " [" + c.unit + "]")))
      found.push_back(i);
  }
  if (found.size() == 1) return found.front();
  std::vector<std::string> headers;
  if (!found.empty()) {
    for (const std::size_t i : found) headers.push_back(columns[i].header);
    return unexpected("column '" + wanted + "' is ambiguous: " + list_of(headers));
  }
  if (const Leftover* other = find_leftover(leftovers, wanted)) return unexpected("'" + wanted + "' " + other->why);
  const std::string first_part = wanted + "[1]";
  if (std::any_of(columns.begin(), columns.end(), [&](const Column& c) { return c.header == first_part; }))
    return unexpected("'" + wanted + "' has several columns: " + first_part + ", " + wanted + "[2] ...; say which");
  const Column* nearest = nullptr;
  std::size_t best = wanted.size() / 3;
  for (const Column& c : columns) {
    headers.push_back(c.header);
    const std::size_t d = std::min(edit_distance(lower(wanted), lower(c.header)), edit_distance(lower(wanted), lower(c.name)));
    if (d < best || (d == best && nearest == nullptr)) {
      best = d;
      nearest = &c;
    }
  }
  std::string text = "no column '" + wanted + "'; the file has " + (headers.empty() ? "none" : list_of(headers));
  if (nearest != nullptr) text += " (did you mean '" + nearest->header + "'?)";
  return unexpected(text);
}

std::optional<double> seconds_per(const std::string& unit) {
  if (!is_unit(unit)) return std::nullopt;
  const auto known = parse_unit(unit);
  if (!known || known->dimension != parse_unit("s")->dimension) return std::nullopt;
  return static_cast<double>(known->numerator) / static_cast<double>(known->denominator) * std::pow(10.0, known->decimal);
}

bool is_named_time(const Column& column) {
  const std::string name = lower(column.name.substr(column.name.find_last_of("/.") + 1));
  return name == "t" || name == "time";
}

bool is_time(const Column& column) { return is_named_time(column) && seconds_per(column.unit).has_value(); }

}  // namespace bodeflow::acquisition
