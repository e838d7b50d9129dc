#pragma once

#include <bodeflow/plant.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

/// What the sentences, units and starts of laws and maps are made of.
namespace bodeflow::residual {

/// The number with so many significant digits.
inline std::string digits(double value, int count) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", count, value);
  return text;
}

/// "0.213 Nm (+-0.004)"; without the bracket where the deviation is not known.
inline std::string quantity(double value, double std, const std::string& unit) {
  const std::string text = digits(value, 4) + (unit.empty() || unit == "1" ? "" : " " + unit);
  return std::isfinite(std) ? text + " (+-" + digits(std, 2) + ")" : text;
}

/// The name of a place as words: "motor_bearing" -> "motor bearing".
inline std::string spoken(std::string name) {
  for (char& c : name) {
    if (c == '_') c = ' ';
  }
  return name;
}

/// A unit that may be divided by, multiplied or raised: "V s" -> "(V s)", "m" -> "m".
inline std::string factor(const std::string& unit) {
  return unit.find_first_of(" /*^") == std::string::npos ? unit : "(" + unit + ")";
}

/// The unit of a over the power of b: "N", "m", 3 -> "N/m^3"; "V", "A" -> "ohm".
inline std::string per(const std::string& a, const std::string& b, int power = 1) {
  if (b.empty() || b == "1") return a;
  if (a == "V" && b == "A" && power == 1) return "ohm";
  return (a.empty() ? "1" : a) + "/" + factor(b) + (power == 1 ? "" : "^" + std::to_string(power));
}

/// A size from data that may be 0 or unknown, as a scale that never is.
inline double size_or_one(double size) { return size > 0.0 && size < std::numeric_limits<double>::infinity() ? size : 1.0; }

/// The linear coefficient at a place that stores: what the base model says, else the largest effort over the largest deflection.
inline double stiffness_of(const Place& place) {
  return size_or_one(place.coefficient > 0.0 ? place.coefficient : place.effort / place.stored);
}

/// The same where something flows: a resistance or a damping.
inline double resistance_of(const Place& place) {
  return size_or_one(place.coefficient > 0.0 ? place.coefficient : place.effort / place.flow);
}

}  // namespace bodeflow::residual
