#pragma once

#include <locale.h>

#include <bodeflow/error.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace bodeflow {

/// A decimal number at the start of a text.
struct NumberText {
  std::string_view mantissa;  ///< sign, digits, point
  long exponent = 0;          ///< the power of ten written behind it, clamped to +-100000
  std::size_t length = 0;     ///< characters in all; 0: the text does not begin with a number
};

/// The longest decimal number that `text` begins with: sign, digits with at most one point, exponent.
inline NumberText scan_number(std::string_view text) {
  const auto digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
  NumberText number;
  std::size_t i = 0, digits = 0;
  if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
  for (; digit(i); ++i) ++digits;
  if (i < text.size() && text[i] == '.') {
    for (++i; digit(i); ++i) ++digits;
  }
  if (digits == 0) return number;
  number.mantissa = text.substr(0, i);
  number.length = i;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    ++i;
    const bool negative = i < text.size() && text[i] == '-';
    if (i < text.size() && (text[i] == '+' || text[i] == '-')) ++i;
    if (!digit(i)) return number;
    for (; digit(i); ++i) {
      if (number.exponent < 100000) number.exponent = 10 * number.exponent + (text[i] - '0');
    }
    if (negative) number.exponent = -number.exponent;
    number.length = i;
  }
  return number;
}

/// The double nearest to mantissa x 10^(exponent + shift), whatever the locale. Infinite where it is beyond double.
inline double nearest_double(const NumberText& number, long shift) {
  static const locale_t classic = newlocale(LC_ALL_MASK, "C", static_cast<locale_t>(nullptr));
  std::string text(number.mantissa);
  text += 'e';
  text += std::to_string(number.exponent + shift);
  return strtod_l(text.c_str(), nullptr, classic);
}

/// The number that `text` is: decimal, correctly rounded, independent of the locale. With `infinite`, "inf" and ".inf" with
/// a sign count too. Error: it is none ("0x10", "1_000", "1,5", "nan"), or it lies beyond the range of double.
inline Expected<double, Error> parse_number(std::string_view text, bool infinite = false) {
  const std::string quoted = "'" + std::string(text.substr(0, 80)) + "'";
  std::string_view bare = text;
  if (!bare.empty() && (bare[0] == '+' || bare[0] == '-')) bare.remove_prefix(1);
  if (bare == "inf" || bare == ".inf") {
    if (!infinite) return unexpected(quoted + " is not allowed: a finite number is needed");
    return text[0] == '-' ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  }
  const NumberText number = scan_number(text);
  if (number.length == 0 || number.length != text.size()) return unexpected(quoted + " is not a number");
  const double value = nearest_double(number, 0);
  if (std::isinf(value)) return unexpected(quoted + " is beyond the range of double");
  return value;
}

}  // namespace bodeflow
