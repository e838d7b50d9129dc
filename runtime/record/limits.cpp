#include "record/limits.hpp"

#include <cmath>

namespace bodeflow::record {
namespace {

nlohmann::ordered_json finite(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

/// Non-finite values as text: in a violation they are what matters.
nlohmann::json value_json(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
}

}  // namespace

nlohmann::ordered_json limits_json(const nlohmann::json& planned, const execute::Outcome& outcome) {
  if (!planned.is_array() || planned.empty()) return nullptr;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < planned.size(); ++i) {
    nlohmann::ordered_json entry;
    for (const char* key :
         {"signal", "side", "channels", "unit", "min", "max", "rate_per_s", "on_violation", "latency_samples", "latency_s"})
      entry[key] = planned[i].at(key);
    if (i < outcome.limits.size()) {
      const execute::LimitRecord& seen = outcome.limits[i];
      entry["samples"] = seen.samples;
      entry["violations"] = seen.violations;
      entry["lowest"] = finite(seen.lowest);
      entry["highest"] = finite(seen.highest);
      entry["steepest_per_s"] = finite(seen.steepest);
      entry["first"] = nullptr;
      if (seen.first)
        entry["first"] = {{"bound", execute::bound_name(seen.first->bound)},
                          {"channel", planned[i].at("channels").at(seen.first->channel)},
                          {"position", seen.first->position},
                          {"time_s", seen.first->time_s},
                          {"value", value_json(seen.first->value)}};
    }
    entry["ended_run"] = outcome.limit == static_cast<int>(i);
    list.push_back(std::move(entry));
  }
  return list;
}

nlohmann::json violation_json(const plan::Limit& limit, const execute::Violation& violation) {
  return {{"signal", limit.signal},
          {"channel", limit.names[violation.channel]},
          {"bound", execute::bound_name(violation.bound)},
          {"position", violation.position},
          {"time_s", violation.time_s},
          {"value", value_json(violation.value)},
          {"unit", limit.unit},
          {"on_violation", plan::action_name(limit.on_violation)}};
}

}  // namespace bodeflow::record
