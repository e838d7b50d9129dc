#include "response_units.hpp"

#include <algorithm>

namespace bodeflow::records {
namespace {

bool is_one(const std::string& unit) { return unit.empty() || unit == "1"; }

}  // namespace

std::string ratio_unit(const std::string& above, const std::string& below) {
  if (is_one(below)) return above;
  if (above == below) return "1";
  const bool simple = below.find_first_of("/* ") == std::string::npos;
  return (is_one(above) ? "1" : above) + "/" + (simple ? below : "(" + below + ")");
}

std::string squared_unit(const std::string& unit) {
  if (is_one(unit)) return unit;
  return unit.find_first_of("/* ^") == std::string::npos ? unit + "^2" : "(" + unit + ")^2";
}

std::string common_unit(const std::vector<std::string>& units) {
  const bool same = std::count(units.begin(), units.end(), units.front()) == static_cast<std::ptrdiff_t>(units.size());
  return same ? units.front() : "";
}

}  // namespace bodeflow::records
