#include "graph/guard.hpp"

#include <fmt/format.h>

#include <bodeflow/utf8.hpp>

namespace bodeflow::graph {
namespace {

/// Bytes of the well-formed character at the front; 0: there is none.
std::size_t character_size(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t size = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
  return lead != 0 && size <= text.size() && is_text(text.substr(0, size)) ? size : 0;
}

struct Line {
  std::string_view text;
  int number;
};

/// False at the first byte of the line that no text has.
bool check_characters(const Line& line, const Source& source, Report& report) {
  int column = 1;
  for (std::string_view rest = line.text; !rest.empty(); ++column) {
    const auto byte = static_cast<unsigned char>(rest.front());
    const Spot spot{&source, line.number, column};
    const std::size_t size = character_size(rest);
    if (byte == 0) {
      report.add(spot, "a NUL byte: this is not a text file");
      return false;
    }
    if (size == 0) {
      report.add(spot, fmt::format("byte 0x{:02X} is not UTF-8: save the file as UTF-8", byte));
      return false;
    }
    const bool last_return = byte == '\r' && rest.size() == 1;
    if ((byte < 0x20 && byte != '\t' && !last_return) || byte == 0x7F) {
      report.add(spot, fmt::format("control character 0x{:02X}", byte));
      return false;
    }
    rest.remove_prefix(size);
  }
  return true;
}

/// Column of a tab in the indentation of a line with content, or 0.
int tab_in_indentation(std::string_view line) {
  const auto content = line.find_first_not_of(" \t\r");
  if (content == std::string_view::npos || line[content] == '#') return 0;
  const auto tab = line.substr(0, content).find('\t');
  return tab == std::string_view::npos ? 0 : static_cast<int>(tab) + 1;
}

bool begins_with_utf16_mark(std::string_view text) {
  return text.size() >= 2 && (text.substr(0, 2) == "\xFF\xFE" || text.substr(0, 2) == "\xFE\xFF");
}

}  // namespace

bool is_readable(std::string_view text, const Source& source, Report& report) {
  const Spot start{&source, source.command_line ? 0 : 1, 1};
  if (text.size() > kLargestFile) {
    report.add({&source, 0, 0}, fmt::format("the file has {} bytes, allowed: {}", text.size(), kLargestFile));
    return false;
  }
  if (trimmed(text).empty()) {
    report.add(start, "the file is empty; a graph file begins with 'bodeflow: 1'");
    return false;
  }
  if (begins_with_utf16_mark(text)) {
    report.add(start, "the file is UTF-16: save it as UTF-8");
    return false;
  }
  int number = 0, tabs = 0;
  Spot first_tab;
  while (!text.empty()) {
    const auto end = text.find('\n');
    const Line line{text.substr(0, end), ++number};
    if (!check_characters(line, source, report)) return false;
    if (const int column = tab_in_indentation(line.text); column > 0 && tabs++ == 0) first_tab = {&source, number, column};
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  if (tabs > 0)
    report.add(first_tab, tabs == 1 ? "a tab in the indentation: use spaces"
                                    : fmt::format("a tab in the indentation (in {} lines): use spaces", tabs));
  return tabs == 0;
}

}  // namespace bodeflow::graph
