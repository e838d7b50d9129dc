#include "record/pacing.hpp"

#include <fmt/format.h>

#include "graph/keys.hpp"

namespace bodeflow::record {
namespace {

/// "53.1 us" of seconds.
std::string time_text(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1.0) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

}  // namespace

nlohmann::ordered_json pacing_json(const graph::RunSettings& run, const execute::Outcome& outcome) {
  if (run.clock == graph::Clock::simulated) return nullptr;
  nlohmann::ordered_json json;
  json["clock"] = graph::clocks()[static_cast<std::size_t>(run.clock)];
  json["on_overrun"] = graph::overruns()[static_cast<std::size_t>(run.on_overrun)];
  json["priority"] = nullptr;
  if (run.priority) json["priority"] = *run.priority;
  json["cores"] = run.cores;
  json["not_permitted"] = outcome.not_permitted;
  json["overruns"] = outcome.overruns;
  json["skipped"] = outcome.skipped;
  const execute::Lateness& late = outcome.lateness;
  json["chunks"] = late.chunks;
  if (late.chunks == 0) return json;
  json["min_s"] = late.min_s;
  json["median_s"] = late.median_s;
  json["p99_s"] = late.p99_s;
  json["max_s"] = late.max_s;
  json["bins"] = late.bins;
  return json;
}

std::string pacing_text(const nlohmann::ordered_json& pacing) {
  if (!pacing.is_object()) return "";
  const auto chunks = pacing.value("chunks", std::uint64_t{0}), overruns = pacing.value("overruns", std::uint64_t{0}),
             skipped = pacing.value("skipped", std::uint64_t{0});
  if (chunks == 0 && overruns == 0) return "";
  const auto time = [&](const char* key) { return time_text(pacing.value(key, 0.0)); };
  std::string text;
  if (chunks > 0)
    text = fmt::format("{} chunks began late by {} in the median, {} at 99 %, {} at most; ", chunks, time("median_s"),
                       time("p99_s"), time("max_s"));
  text += fmt::format("{} overrun{}", overruns, overruns == 1 ? "" : "s");
  if (skipped > 0) text += fmt::format(", {} chunks of time left out", skipped);
  return text;
}

}  // namespace bodeflow::record
