#include "part_checks.hpp"

#include <algorithm>
#include <bodeflow/units.hpp>
#include <cmath>
#include <cstring>
#include <set>

namespace bodeflow::testing {
namespace {

/// A symbol of physics, "Lm_beta": a letter, then letters, digits and _.
bool is_symbol(const std::string& name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (name.empty() || !is_letter(name[0])) return false;
  return std::all_of(name.begin(), name.end(), [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

}  // namespace

std::string problem_of(const std::vector<FitParameter>& parameters) {
  std::set<std::string> names;
  for (const FitParameter& p : parameters) {
    const std::string what = "parameter '" + p.name + "': ";
    if (!is_symbol(p.name)) return what + "name is not a word of letters, digits and _";
    if (!names.insert(p.name).second) return what + "name stands twice";
    if (!is_known_unit(p.unit)) return what + "unit '" + p.unit + "' is unknown";
    if (!(p.low < p.high)) return what + "nothing lies between its bounds";
    if (p.logarithmic && p.low < 0.0) return what + "is fitted as a logarithm, but may be negative";
    if (!(p.scale > 0.0) || !std::isfinite(p.scale)) return what + "its size is not a finite positive number";
  }
  return {};
}

std::string problem_of(const std::vector<std::vector<double>>& starts, const std::vector<FitParameter>& parameters) {
  if (starts.empty()) return "gives no start";
  for (const auto& start : starts) {
    if (start.size() != parameters.size()) {
      return "gives a start of " + std::to_string(start.size()) + " values for " + std::to_string(parameters.size()) +
             " parameters";
    }
    for (std::size_t i = 0; i < start.size(); ++i) {
      const FitParameter& p = parameters[i];
      const std::string what = "starts '" + p.name + "' at " + std::to_string(start[i]);
      if (!std::isfinite(start[i])) return what;
      if (p.logarithmic && !(start[i] > 0.0)) return what + ", which has no logarithm";
      if (start[i] < p.low || start[i] > p.high) return what + ", outside of its bounds";
    }
  }
  return {};
}

bool same_bits(const double* a, const double* b, std::size_t count) {
  return count == 0 || std::memcmp(a, b, count * sizeof(double)) == 0;
}

}  // namespace bodeflow::testing
