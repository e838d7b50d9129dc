#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "plan/limits.hpp"

namespace bodeflow::execute {

/// Which part of a limit a sample leaves; `finite`: it is not a finite number.
enum class Bound { none, finite, min, max, rate };

/// "finite", "min", "max", "rate".
const char* bound_name(Bound bound);

/// A sample that left a limit.
struct Violation {
  Bound bound = Bound::none;
  std::size_t channel = 0;     ///< index into plan::Limit::channels
  std::uint64_t position = 0;  ///< of the sample on its port, from 0
  double time_s = 0.0;         ///< position over the stream's rate
  double value = 0.0;          ///< of the sample; for `rate` its change, per second
};

/// What a limit has seen in a run, of all its channels together.
struct LimitRecord {
  std::uint64_t samples = 0;     ///< that were looked at
  std::uint64_t violations = 0;  ///< of them
  std::optional<Violation> first;
  /// Of the signal as it came, finite samples only; NaN where there was none. The change per second between neighbours.
  double lowest = 0.0, highest = 0.0, steepest = 0.0;
};

/// "speed is 1652.3 rpm at sample 612 (12.24 s), allowed: at most 1650 rpm".
std::string to_text(const plan::Limit& limit, const Violation& violation);

}  // namespace bodeflow::execute
