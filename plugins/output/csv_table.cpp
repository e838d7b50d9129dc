#include "csv_table.hpp"

#include <bodeflow/error.hpp>
#include <set>

namespace bodeflow::output {

std::vector<std::string> headers(const std::vector<Signal>& signals, bool time) {
  std::vector<std::string> all;
  std::set<std::string> seen;
  const auto add = [&](const std::string& name, const std::string& unit) {
    if (!seen.insert(name).second) fail("two columns named '" + name + "'; name them apart with columns: [...]");
    all.push_back(unit.empty() ? name : name + " [" + unit + "]");
  };
  if (time) add("t", "s");
  for (const Signal& s : signals) {
    if (s.name.empty()) fail("a column without a name; name the columns with columns: [...]");
    if (s.name.find_first_of("\r\n") != std::string::npos) fail("a column name with a line end in it");
    if (s.complex) {
      add("re(" + s.name + ")", s.unit);
      add("im(" + s.name + ")", s.unit);
    } else {
      add(s.name, s.unit);
    }
  }
  return all;
}

std::string csv_line(const std::vector<std::string>& texts) {
  std::string line;
  for (const std::string& text : texts) {
    if (!line.empty()) line += ',';
    if (text.find_first_of(",\"") == std::string::npos) {
      line += text;
      continue;
    }
    line += '"';
    for (const char c : text) {
      if (c == '"') line += '"';
      line += c;
    }
    line += '"';
  }
  return line + '\n';
}

}  // namespace bodeflow::output
