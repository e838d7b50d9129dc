#include "record/pacing.hpp"

#include <fmt/format.h>

namespace bodeflow::record {
namespace {

bool is_paced(const execute::Outcome& outcome) { return outcome.lateness.chunks > 0 || outcome.overruns > 0; }

/// "53.1 us" of seconds.
std::string time_text(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1.0) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

}  // namespace

nlohmann::ordered_json pacing_json(const execute::Outcome& outcome) {
  if (!is_paced(outcome)) return nullptr;
  const execute::Lateness& late = outcome.lateness;
  return {{"overruns", outcome.overruns}, {"skipped", outcome.skipped}, {"chunks", late.chunks}, {"min_s", late.min_s},
          {"median_s", late.median_s},    {"p99_s", late.p99_s},        {"max_s", late.max_s},   {"bins", late.bins}};
}

std::string pacing_text(const execute::Outcome& outcome) {
  if (!is_paced(outcome)) return "";
  const execute::Lateness& late = outcome.lateness;
  std::string text;
  if (late.chunks > 0)
    text = fmt::format("{} chunks began late by {} in the median, {} at 99 %, {} at most; ", late.chunks,
                       time_text(late.median_s), time_text(late.p99_s), time_text(late.max_s));
  text += fmt::format("{} overrun{}", outcome.overruns, outcome.overruns == 1 ? "" : "s");
  if (outcome.skipped > 0) text += fmt::format(", {} chunks of time left out", outcome.skipped);
  return text;
}

}  // namespace bodeflow::record
