#include "execute/violation.hpp"

#include <fmt/format.h>

#include <cmath>

namespace bodeflow::execute {

const char* bound_name(Bound bound) {
  switch (bound) {
    case Bound::finite:
      return "finite";
    case Bound::min:
      return "min";
    case Bound::max:
      return "max";
    case Bound::rate:
      return "rate";
    default:
      return "none";
  }
}

std::string to_text(const plan::Limit& limit, const Violation& violation) {
  const bool one = limit.channels.size() == 1 && limit.all_channels;
  std::string text = limit.signal + (one ? "" : ", channel " + limit.names[violation.channel]);
  if (violation.bound == Bound::rate)
    text += fmt::format(" changes by {}", plan::value_text(violation.value, limit.unit.empty() ? "1/s" : limit.unit + "/s"));
  else if (violation.bound == Bound::finite)
    text += fmt::format(" is {}", violation.value);
  else
    text += " is " + plan::value_text(violation.value, limit.unit);
  return fmt::format("{} at sample {} ({:.6g} s), allowed: {}", text, violation.position, violation.time_s,
                     violation.bound == Bound::finite ? "finite numbers, " + plan::bounds_text(limit) : plan::bounds_text(limit));
}

}  // namespace bodeflow::execute
