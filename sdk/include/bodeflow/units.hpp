#pragma once

#include <bodeflow/number.hpp>
#include <bodeflow/unit_parse.hpp>
#include <cmath>
#include <string>
#include <string_view>

namespace bodeflow {

/// True for "" (any unit), "1" (no dimension), and every unit that parse_unit reads.
inline bool is_known_unit(std::string_view unit) { return unit.empty() || parse_unit(unit).has_value(); }

/// True if numbers in one unit can be converted to the other. "" goes with everything; units that are not known go with
/// themselves alone.
inline bool same_dimension(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty() || a == b) return true;
  const auto first = parse_unit(a), second = parse_unit(b);
  return first && second && first->dimension == second->dimension;
}

/// True if a number means the same in both units: "Nm" and "kg m^2/s^2", but not "mV" and "V". "" goes with everything.
inline bool same_unit(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty() || a == b) return true;
  const auto first = parse_unit(a), second = parse_unit(b);
  return first && second && *first == *second;
}

/// What a dimension is called, with its article: "a voltage"; "a quantity" where it has no name here.
inline std::string dimension_name(const Dimension& dimension) {
  static const std::vector<std::pair<const char*, const char*>> names = {
      {"1", "a number without dimension"},
      {"dB", "a level"},
      {"m", "a length"},
      {"kg", "a mass"},
      {"s", "a time"},
      {"A", "a current"},
      {"K", "a temperature"},
      {"rad", "an angle"},
      {"Hz", "a frequency"},
      {"rad/s", "an angular frequency"},
      {"rad/s^2", "an angular acceleration"},
      {"m/s", "a velocity"},
      {"m/s^2", "an acceleration"},
      {"m^2", "an area"},
      {"m^3", "a volume"},
      {"N", "a force"},
      {"Nm", "a torque or energy"},
      {"W", "a power"},
      {"Pa", "a pressure"},
      {"V", "a voltage"},
      {"ohm", "a resistance"},
      {"S", "a conductance"},
      {"F", "a capacitance"},
      {"H", "an inductance"},
      {"Wb", "a magnetic flux"},
      {"T", "a magnetic flux density"},
      {"C", "a charge"},
      {"kg m^2", "a moment of inertia"},
      {"Nm/rad", "a torsional stiffness"},
      {"N/m", "a stiffness"},
      {"Hz/s", "a sweep rate"},
      {"V/s", "a rate of change of voltage"},
  };
  for (const auto& [unit, name] : names) {
    if (parse_unit(unit)->dimension == dimension) return name;
  }
  return "a quantity";
}

namespace detail {

inline double pi_power(int halves) {
  constexpr double kPi = 3.14159265358979323846;
  double factor = 1.0;
  for (int i = 0; i < std::abs(halves) / 2; ++i) factor *= kPi;
  return halves % 2 != 0 ? factor * std::sqrt(kPi) : factor;
}

/// mantissa x 10^.. in `from`, as a number in `to`. Powers of ten go into the decimal text, so that "1.5 us" in s is the
/// double nearest to 1.5e-6.
inline double rescale(const NumberText& number, const Unit& from, const Unit& to) {
  if (from == to) return nearest_double(number, 0);
  if (from.offset != 0.0 || to.offset != 0.0) {
    const double kelvin = nearest_double(number, from.decimal) + from.offset;
    return (kelvin - to.offset) * std::pow(10.0, -to.decimal);
  }
  const std::int64_t g = std::gcd(from.numerator, to.numerator), h = std::gcd(from.denominator, to.denominator);
  const double up = static_cast<double>(from.numerator / g) * static_cast<double>(to.denominator / h);
  const double down = static_cast<double>(from.denominator / h) * static_cast<double>(to.numerator / g);
  double value = nearest_double(number, from.decimal - to.decimal);
  if (up != 1.0) value *= up;  // NOLINT: factors of one leave the bits alone
  if (down != 1.0) value /= down;
  const int pi = from.pi - to.pi;
  if (pi > 0) value *= pi_power(pi);
  if (pi < 0) value /= pi_power(pi);
  return value;
}

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

inline std::string wrong_dimension(std::string_view text, std::string_view found_unit, const Unit& found, std::string_view unit,
                                   const Unit& wanted) {
  const auto named = [](const Unit& u, std::string_view symbol, bool with_unit) {
    std::string name = dimension_name(u.dimension);
    if (u.dimension == Dimension{}) return name;
    return with_unit || name == "a quantity" ? name + " in " + std::string(symbol) : name;
  };
  return std::string(text.substr(0, 80)) + " is " + named(found, found_unit, false) + "; allowed: " + named(wanted, unit, true);
}

}  // namespace detail

/// The number that `text` gives in `unit`: "1.5 us" in "s" is 1.5e-6, a bare number is in `unit` already, "50 %" in "1" is
/// 0.5. In the unit "" (any) a quantity counts in coherent SI units, degC as degC. With `infinite`, "inf", ".inf" and their
/// negatives are allowed. Error: not a number, an unknown unit (with the nearest known one), another dimension (what was
/// found, what is allowed), beyond the range of double.
inline Expected<double, Error> convert(std::string_view text, std::string_view unit, bool infinite = false) {
  text = detail::trimmed(text);
  const NumberText number = scan_number(text);
  if (number.length == 0 || number.length == text.size()) return parse_number(text, infinite);
  const std::string_view found_unit = detail::trimmed(text.substr(number.length));
  const char first = found_unit.front();
  const bool is_hex = (first == 'x' || first == 'X') && number.length == text.size() - found_unit.size();
  if (first == '_' || first == ',' || first == '.' || first == '+' || first == '-' || is_hex ||
      (first >= '0' && first <= '9' && found_unit != "1")) {
    return unexpected("'" + std::string(text.substr(0, 80)) + "' is not a number");
  }
  const auto found = parse_unit(found_unit);
  if (!found) return unexpected("'" + std::string(text.substr(0, 80)) + "': " + found.error().text);
  Unit wanted;
  wanted.dimension = found->dimension;
  wanted.offset = found->offset;
  if (!unit.empty()) {
    const auto known = parse_unit(unit);
    if (!known) return unexpected("'" + std::string(text.substr(0, 80)) + "': the parameter's own " + known.error().text);
    wanted = *known;
  }
  if (wanted.dimension != found->dimension) return unexpected(detail::wrong_dimension(text, found_unit, *found, unit, wanted));
  const double value = detail::rescale(number, *found, wanted);
  if (std::isinf(value)) return unexpected("'" + std::string(text.substr(0, 80)) + "' is beyond the range of double");
  return value;
}

}  // namespace bodeflow
