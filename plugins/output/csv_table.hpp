#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bodeflow::output {

/// One stream channel as a column, or as two where it is complex.
struct Signal {
  std::string name;
  std::string unit;
  bool complex = false;
};

/// The column headers of these signals: `name [unit]`, or `re(name) [unit]` and `im(name) [unit]`. Throws Failure for names that
/// stand twice or that are empty.
std::vector<std::string> headers(const std::vector<Signal>& signals, bool time);

/// One line of a CSV file: texts with commas between them and LF at the end; a text with a comma or quote in it is quoted.
std::string csv_line(const std::vector<std::string>& texts);

}  // namespace bodeflow::output
