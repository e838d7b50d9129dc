#pragma once

#include <bodeflow/rate.hpp>
#include <cstdint>
#include <limits>
#include <optional>

namespace bodeflow::plan {

/// Intermediate results of products of two 64-bit numbers.
using Wide = __int128;

/// The value as 64 bits, or nothing when it does not fit.
inline std::optional<std::int64_t> narrow(Wide value) {
  if (value > std::numeric_limits<std::int64_t>::max() || value < std::numeric_limits<std::int64_t>::min()) return std::nullopt;
  return static_cast<std::int64_t>(value);
}

/// Greatest common divisor of two numbers >= 0.
inline Wide greatest_common_divisor(Wide a, Wide b) {
  while (b != 0) {
    const Wide rest = a % b;
    a = b;
    b = rest;
  }
  return a;
}

/// Rounded towards minus infinity; `divisor` > 0.
inline Wide floor_divide(Wide value, Wide divisor) {
  const Wide quotient = value / divisor;
  return value % divisor < 0 ? quotient - 1 : quotient;
}

/// Rounded towards plus infinity; `divisor` > 0.
inline Wide ceil_divide(Wide value, Wide divisor) { return -floor_divide(-value, divisor); }

/// num / den in lowest terms, or nothing when it does not fit into 64 bits. den > 0.
inline std::optional<Rate> fraction(Wide num, Wide den) {
  const Wide divisor = greatest_common_divisor(num < 0 ? -num : num, den);
  const auto n = narrow(divisor > 1 ? num / divisor : num);
  const auto d = narrow(divisor > 1 ? den / divisor : den);
  if (!n || !d) return std::nullopt;
  return Rate{*n, *d};
}

inline std::optional<Rate> multiply(const Rate& a, const Rate& b) { return fraction(Wide{a.num} * b.num, Wide{a.den} * b.den); }

/// a / b; b > 0.
inline std::optional<Rate> divide(const Rate& a, const Rate& b) { return fraction(Wide{a.num} * b.den, Wide{a.den} * b.num); }

inline bool less(const Rate& a, const Rate& b) { return Wide{a.num} * b.den < Wide{b.num} * a.den; }

/// The smallest fraction that is a whole multiple of both (both > 0), or nothing when it does not fit.
inline std::optional<Rate> common_multiple(const Rate& a, const Rate& b) {
  const auto num = narrow(Wide{a.num} / greatest_common_divisor(a.num, b.num) * b.num);
  const Wide den = greatest_common_divisor(a.den, b.den);
  if (!num) return std::nullopt;
  return fraction(*num, den);
}

/// Whole firings in `time` at `rate`: floor(time * rate), largest 64-bit number where it is larger.
inline std::int64_t whole_firings(const Rate& time, const Rate& rate) {
  const Wide num = Wide{time.num} * rate.num;
  return narrow(floor_divide(num, Wide{time.den} * rate.den)).value_or(std::numeric_limits<std::int64_t>::max());
}

/// As whole_firings, rounded up.
inline std::int64_t covering_firings(const Rate& time, const Rate& rate) {
  const Wide num = Wide{time.num} * rate.num;
  return narrow(ceil_divide(num, Wide{time.den} * rate.den)).value_or(std::numeric_limits<std::int64_t>::max());
}

}  // namespace bodeflow::plan
