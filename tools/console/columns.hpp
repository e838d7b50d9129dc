#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace bodeflow::tools {

// What the tables of the screen consist of.

/// A number in a column; "-" where there is none.
inline std::string cell(double value, int width = 12, int digits = 5) {
  return std::isfinite(value) ? fmt::format("{:>{}.{}g}", value, width, digits) : fmt::format("{:>{}}", "-", width);
}

/// "gamma [1/s]".
inline std::string named(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : name + " [" + unit + "]";
}

/// The text, or its beginning with dots behind.
inline std::string shortened(const std::string& text, std::size_t most) {
  return text.size() <= most ? text : text.substr(0, most - 3) + "...";
}

}  // namespace bodeflow::tools
