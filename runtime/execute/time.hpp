#pragma once

#include <bodeflow/rate.hpp>
#include <cstdint>

namespace bodeflow::execute {

/// A time of the run's clock in seconds, an exact fraction in lowest terms: den > 0.
struct Time {
  __int128 num = 0;
  __int128 den = 1;

  bool operator==(const Time& other) const { return num == other.num && den == other.den; }
};

/// When firing `position` begins on a clock of `rate` firings per second (rate > 0).
Time time_of(std::int64_t position, const Rate& rate);

/// `count` times `seconds`.
Time multiple_of(std::int64_t count, const Rate& seconds);

/// `time` + `seconds`.
Time later(const Time& time, const Rate& seconds);

/// Exact for any two times: compares quotients and remainders, so that nothing overflows.
bool operator<(const Time& a, const Time& b);

/// Index of the first firing at or after `time` on a clock of `rate` firings per second; the largest 64-bit number beyond it.
std::int64_t first_firing(const Time& time, const Rate& rate);

/// Nearest double.
double seconds(const Time& time);

}  // namespace bodeflow::execute
