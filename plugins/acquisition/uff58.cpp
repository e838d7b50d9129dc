#include "uff58.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "csv_row.hpp"

namespace bodeflow::acquisition {
namespace {

constexpr std::int64_t kMostPoints = std::int64_t{1} << 40;

Unexpected<TextError> refuse(std::int64_t line, std::int64_t column, std::string text) {
  return {TextError{line, column, std::move(text)}};
}

Unexpected<TextError> forward(const TextError& e) { return {e}; }

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// The label in these columns of a line (from 0); "NONE" says nothing.
std::string label(std::string_view line, std::size_t from, std::size_t length) {
  if (from >= line.size()) return "";
  const std::string_view text = trimmed(line.substr(from, length));
  return text == "NONE" ? "" : std::string(text);
}

/// The header of one function: eleven records.
class HeaderReader {
 public:
  HeaderReader(LineReader& lines, Uff58Function& f) : lines_(lines), f_(f) {}
  Expected<void, TextError> read();

 private:
  Expected<std::string, TextError> record(const char* what);
  Expected<void, TextError> read_freedom(const std::string& line);
  Expected<void, TextError> read_form(const std::string& line);
  void read_axis(const std::string& line, int& type, std::string& name, std::string& unit) const;
  Expected<int, TextError> whole(const std::string& line, std::size_t from, std::size_t length, const char* what) const;

  LineReader& lines_;
  Uff58Function& f_;
};

Expected<std::string, TextError> HeaderReader::record(const char* what) {
  const auto more = lines_.next();
  if (!more) return forward(more.error());
  if (!*more || is_uff_mark(lines_.line()))
    return refuse(lines_.number(), 0, std::string("function ends in its header, before ") + what);
  return std::string(lines_.line());
}

/// A whole number in fixed columns; blank is 0.
Expected<int, TextError> HeaderReader::whole(const std::string& line, std::size_t from, std::size_t length,
                                             const char* what) const {
  if (from >= line.size()) return 0;
  const std::string_view text = trimmed(std::string_view(line).substr(from, length));
  int value = 0;
  const auto [stop, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!text.empty() && (code != std::errc{} || stop != text.data() + text.size()))
    return refuse(lines_.number(), static_cast<std::int64_t>(from) + 1,
                  std::string(what) + ": " + shown(text) + " is no whole number");
  return value;
}

Expected<void, TextError> HeaderReader::read_freedom(const std::string& line) {
  struct Field {
    int* to;
    std::size_t from, length;
    const char* what;
  };
  for (const Field& f :
       {Field{&f_.kind, 0, 5, "function type"}, Field{&f_.response_node, 41, 10, "response node"},
        Field{&f_.response_direction, 51, 4, "response direction"}, Field{&f_.reference_node, 66, 10, "reference node"},
        Field{&f_.reference_direction, 76, 4, "reference direction"}}) {
    const auto value = whole(line, f.from, f.length, f.what);
    if (!value) return forward(value.error());
    *f.to = *value;
  }
  return {};
}

Expected<void, TextError> HeaderReader::read_form(const std::string& line) {
  constexpr const char* kNames[] = {"data type", "number of points", "spacing of the abscissa", "least abscissa",
                                    "abscissa increment"};
  double values[5] = {};
  std::size_t at = 0;
  for (int i = 0; i < 5; ++i) {
    const std::size_t begin = at;
    const auto value = take_number(line, at);
    if (!value || !std::isfinite(*value)) {
      const auto from = std::min(line.find_first_not_of(" \t", begin), line.size());
      return refuse(lines_.number(), static_cast<std::int64_t>(from) + 1,
                    std::string(kNames[i]) + ": " + shown(std::string_view(line).substr(from)) + " is no number");
    }
    values[i] = *value;
  }
  const double type = values[0];
  if (type != 2.0 && type != 4.0 && type != 5.0 && type != 6.0)
    return refuse(lines_.number(), 1,
                  "data type " + std::to_string(static_cast<long>(std::clamp(type, -1e9, 1e9))) +
                      "; known are 2, 4 (real) and 5, 6 (complex)");
  f_.complex = type > 4.0;
  f_.double_precision = type == 4.0 || type == 6.0;
  if (!(values[1] >= 1.0) || values[1] > static_cast<double>(kMostPoints) || values[1] != std::floor(values[1]))
    return refuse(lines_.number(), 11,
                  "a function of " + std::to_string(static_cast<long>(std::clamp(values[1], -1e15, 1e15))) + " points");
  f_.points = static_cast<std::int64_t>(values[1]);
  f_.even = values[2] != 0.0;
  f_.start = values[3];
  f_.step = values[4];
  return {};
}

void HeaderReader::read_axis(const std::string& line, int& type, std::string& name, std::string& unit) const {
  std::size_t at = 0;
  const auto number = take_number(line, at);
  type = number && std::abs(*number) < 1e6 ? static_cast<int>(*number) : 0;
  name = label(line, 26, 20);
  unit = label(line, 47, 20);
}

Expected<void, TextError> HeaderReader::read() {
  for (int i = 0; i < 5; ++i) {
    const auto line = record("its form (record 7)");
    if (!line) return forward(line.error());
    if (f_.title.empty()) f_.title = label(*line, 0, 80);
  }
  const auto freedom = record("its form (record 7)");
  if (!freedom) return forward(freedom.error());
  if (auto done = read_freedom(*freedom); !done) return done;
  const auto form = record("its form (record 7)");
  if (!form) return forward(form.error());
  if (auto done = read_form(*form); !done) return done;
  int unused = 0;
  std::string no_name;
  const auto abscissa = record("its axes (records 8 to 11)");
  if (!abscissa) return forward(abscissa.error());
  read_axis(*abscissa, f_.abscissa_type, no_name, f_.abscissa_unit);
  const auto ordinate = record("its axes (records 8 to 11)");
  if (!ordinate) return forward(ordinate.error());
  read_axis(*ordinate, f_.ordinate_type, f_.ordinate_label, f_.ordinate_unit);
  const auto reference = record("its axes (records 8 to 11)");
  if (!reference) return forward(reference.error());
  read_axis(*reference, unused, no_name, f_.reference_unit);
  if (const auto last = record("its axes (records 8 to 11)"); !last) return forward(last.error());
  f_.line = lines_.number() + 1;
  f_.offset = lines_.offset();
  return {};
}

/// What record 1 of a binary function says: "    58b     1     2          11        4096 ...".
Expected<void, TextError> read_binary_mark(const LineReader& lines, Uff58Function& f) {
  const std::string_view line = lines.line();
  std::size_t at = line.find('b') + 1;
  const auto order = take_number(line, at), floating = take_number(line, at), records = take_number(line, at),
             bytes = take_number(line, at);
  if (!bytes || !(*bytes >= 0.0) || *bytes > 9e15)
    return refuse(lines.number(), 0, "binary function without its number of bytes");
  if (*floating != 2.0) return refuse(lines.number(), 0, "binary function in other numbers than IEEE 754");
  if (*records != 11.0) return refuse(lines.number(), 0, "binary function with another header than 11 records");
  f.big_endian = *order == 2.0;
  f.bytes = static_cast<std::int64_t>(*bytes);
  return {};
}

/// To the line "-1" that ends the data set, which began in `line`.
Expected<void, TextError> skip_to_mark(LineReader& lines, std::int64_t line) {
  while (true) {
    const auto more = lines.next();
    if (!more) return forward(more.error());
    if (!*more)
      return refuse(0, 0, "the data set of line " + std::to_string(line) + " is not closed by -1: is the file cut off?");
    if (is_uff_mark(lines.line())) return {};
  }
}

Expected<void, TextError> read_function(LineReader& lines, bool binary, Uff58File& file) {
  Uff58Function f;
  const std::int64_t line = lines.number();
  if (binary) {
    if (auto done = read_binary_mark(lines, f); !done) return done;
  }
  if (auto done = HeaderReader(lines, f).read(); !done) return done;
  if (binary) {
    const std::int64_t needed = f.points * f.numbers_per_point() * (f.double_precision ? 8 : 4);
    if (f.bytes != needed) {
      return refuse(line, 0,
                    "binary function states " + std::to_string(f.bytes) + " bytes, its " + std::to_string(f.points) +
                        " points need " + std::to_string(needed));
    }
    if (auto done = lines.go_to(f.offset + f.bytes, f.line); !done) return done;
  }
  file.functions.push_back(std::move(f));
  return skip_to_mark(lines, line);
}

}  // namespace

bool is_uff_mark(std::string_view line) { return trimmed(line) == "-1"; }

std::optional<double> take_number(std::string_view line, std::size_t& at) {
  while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  std::size_t begin = at;
  if (begin + 1 < line.size() && line[begin] == '+' && line[begin + 1] != '-') ++begin;
  double value = 0.0;
  const auto [stop, code] = std::from_chars(line.data() + begin, line.data() + line.size(), value);
  if (code != std::errc{}) return std::nullopt;
  const auto end = static_cast<std::size_t>(stop - line.data());
  if (end < line.size() && line[end] != ' ' && line[end] != '\t') return std::nullopt;
  at = end;
  return value;
}

Expected<Uff58File, TextError> read_uff58(LineReader& lines) {
  Uff58File file;
  while (true) {
    const auto more = lines.next();
    if (!more) return forward(more.error());
    if (!*more) break;
    if (trimmed(lines.line()).empty()) continue;
    if (!is_uff_mark(lines.line())) {
      if (file.functions.empty() && file.others == 0)
        return refuse(lines.number(), 1, "is no universal file: " + shown(lines.line()) + " where a data set begins with -1");
      return refuse(lines.number(), 1, shown(lines.line()) + " where a data set begins with -1");
    }
    const std::int64_t begun = lines.number();
    const auto there = lines.next();
    if (!there) return forward(there.error());
    if (!*there) return refuse(begun, 0, "a data set begins here and the file ends");
    const std::string_view kind = trimmed(lines.line());
    if (kind == "58" || kind.substr(0, 3) == "58b") {
      if (auto done = read_function(lines, kind != "58", file); !done) return forward(done.error());
    } else {
      ++file.others;
      if (auto done = skip_to_mark(lines, begun); !done) return forward(done.error());
    }
  }
  if (file.functions.empty() && file.others == 0) return refuse(0, 0, "empty file");
  return file;
}

std::string degree_of_freedom(int node, int direction) {
  constexpr const char* kAxes[] = {"", "X", "Y", "Z", "RX", "RY", "RZ"};
  const int axis = std::abs(direction);
  if (axis == 0 || axis > 6) return std::to_string(node);
  return std::to_string(node) + (direction < 0 ? "-" : "+") + kAxes[axis];
}

}  // namespace bodeflow::acquisition
