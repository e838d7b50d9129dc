#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace bodeflow::tools::report {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A number for people: "0.01235", "1.235×10⁻⁵"; "–" where it is not finite.
std::string shown(double value, int digits = 4);
/// The same with its unit; a unit "" or "1" is left out.
std::string shown(double value, const std::string& unit, int digits = 4);
/// "12.3 %" of a fraction.
std::string percent(double fraction);
/// "1,234,567".
std::string counted(std::uint64_t count);
/// "title [unit]", or the title alone for a number without unit.
std::string with_unit(const std::string& title, const std::string& unit);
/// "10⁻³" for -3.
std::string power_of_ten(int exponent);
/// A coordinate in a drawing: at most one decimal, 0 where the value is not finite.
std::string coordinate(double value);

/// 20 lg |x|; -infinity at 0.
double decibel(double magnitude);

/// The median of the finite values, NaN without any. Reorders the values.
double median(std::vector<double> values);

/// Phases [degrees] without jumps of more than half a turn from one trusted line to the next; those that are not trusted stay
/// nearest to the last trusted one and carry nothing on. The first trusted one is in (-180, 180].
std::vector<double> unwrapped(std::vector<double> degrees, const std::vector<bool>& trusted);

}  // namespace bodeflow::tools::report
