#pragma once

#include <bodeflow/block.hpp>
#include <bodeflow/numerics/error.hpp>
#include <string>
#include <utility>

#include "hertz.hpp"

/// What the generators have in common: a stream that begins here has a sample rate and a unit of its own.
namespace bodeflow::generators {

inline constexpr double kMaxRateHz = 1e12;

/// Describes the parameters `sample_rate` and `unit`.
void describe_source(Describe& d);

/// The exact sample rate that the graph gives.
Rate source_rate(const Parameters& p);

/// The facts of a source's output.
StreamFacts source_facts(Rate rate, const std::string& unit, int channels = 1, std::int64_t length = -1);

/// The first sample at or after a time [s]; a time within rounding of a sample is that sample. Fails beyond what can be counted.
std::uint64_t first_sample(double time_s, Rate rate);

/// How many of a call's firings lie before `length` (all of them where it is negative); tells the engine where the stream ends.
std::size_t before_end(Io& io, std::int64_t length);

/// A whole number that sizes something: fails outside of lowest .. highest, whatever the host let through.
std::int64_t whole(const Parameters& p, const char* name, std::int64_t lowest, std::int64_t highest);

/// The value of a result; fails with its error.
template <class T>
T valid(numerics::Expected<T> result) {
  if (!result) fail(result.error().text);
  return std::move(*result);
}

}  // namespace bodeflow::generators
