#include "report/limits_section.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/json_fields.hpp"

namespace bodeflow::tools::report {
namespace {

using nlohmann::ordered_json;

std::string per_second(const std::string& unit) { return (unit.empty() ? "1" : unit) + "/s"; }

/// "−800 to 800 rpm, at most 2000 rpm/s" of the fields with these names.
std::string range_text(const ordered_json& limit, const char* low, const char* high, const char* steep) {
  const std::string unit = text_in(limit, "unit");
  const double min = number_in(limit, low), max = number_in(limit, high), rate = number_in(limit, steep);
  std::string text;
  if (std::isfinite(min) && std::isfinite(max))
    text = fmt::format("{} to {}", shown(min), shown(max, unit));
  else if (std::isfinite(min))
    text = "at least " + shown(min, unit);
  else if (std::isfinite(max))
    text = "at most " + shown(max, unit);
  if (std::isfinite(rate))
    text += fmt::format("{}changes of at most {}", text.empty() ? "" : ", ", shown(rate, per_second(unit)));
  return text;
}

/// "loop.drive.feedback speed", repetitions counted from 2 on.
std::string signal(const ordered_json& phase, const ordered_json& limit) {
  const std::string name = text_in(phase, "phase");
  std::string text = (name.empty() ? "" : name + ".") + text_in(limit, "signal");
  const auto channels = limit.find("channels");
  const bool one = channels != limit.end() && channels->is_array() && channels->size() == 1 && channels->front().is_string();
  if (one && channels->front() != "0") text += " " + channels->front().get<std::string>();
  const std::uint64_t repeat = count_in(phase, "repeat");
  return repeat > 0 ? fmt::format("{} (repetition {})", text, repeat + 1) : text;
}

/// ", the first at 1.94 s: 456 rpm".
std::string first_of(const ordered_json& limit) {
  const auto first = limit.find("first");
  if (first == limit.end() || !first->is_object()) return "";
  const std::string unit = text_in(limit, "unit");
  const double value = number_in(*first, "value");
  const std::string what = std::isfinite(value) ? shown(value, text_in(*first, "bound") == "rate" ? per_second(unit) : unit)
                                                : text_in(*first, "value");
  return fmt::format(", the first at {}: {}", shown(number_in(*first, "time_s"), "s", 6), what);
}

std::string action(const ordered_json& limit) {
  const auto ended = limit.find("ended_run");
  const bool stopped = ended != limit.end() && ended->is_boolean() && ended->get<bool>();
  return stopped ? "ended the run" : text_in(limit, "on_violation");
}

}  // namespace

void add_limits(Page& page, const RunData& run) {
  Table table{"", {{"Signal", false}, {"Allowed", false}, {"Came", false}, {"Violations", false}, {"On violation", false}}, {}};
  const auto phases = run.manifest.find("phases");
  if (phases == run.manifest.end() || !phases->is_array()) return;
  for (const auto& phase : *phases) {
    if (!phase.is_object() || !phase.contains("limits") || !phase["limits"].is_array()) continue;
    for (const auto& limit : phase["limits"]) {
      if (!limit.is_object()) continue;
      table.rows.push_back({signal(phase, limit), range_text(limit, "min", "max", "rate_per_s"),
                            range_text(limit, "lowest", "highest", "steepest_per_s"),
                            fmt::format("{} of {}{}", counted(count_in(limit, "violations")), counted(count_in(limit, "samples")),
                                        first_of(limit)),
                            action(limit)});
    }
  }
  if (table.rows.empty()) return;
  page.open_section("Limits");
  add_table(page.body(), table);
  page.close_section();
}

}  // namespace bodeflow::tools::report
