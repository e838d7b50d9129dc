#include "phases/limits.hpp"

#include <fmt/format.h>

#include "record/limits.hpp"

namespace bodeflow::phases {
namespace {

const char* what_they_did(const plan::Limit& limit) {
  return limit.on_violation == graph::OnViolation::clamp ? "were held within" : "left";
}

}  // namespace

void LimitTeller::violated(int limit, const execute::Violation& violation) const {
  const plan::Limit& violated = plan_.limits[static_cast<std::size_t>(limit)];
  nlohmann::json details = record::violation_json(violated, violation);
  details["phase"] = phase_.name;
  details["repeat"] = repeat_;
  directory_.event("limit violated", std::move(details));
  if (violated.on_violation == graph::OnViolation::stop) return;  // the reason of the run's end tells it
  const char* held = violated.on_violation == graph::OnViolation::clamp ? "; it is held within" : "";
  services_.log("limits", BF_LOG_WARNING, execute::to_text(violated, violation) + held);
}

void LimitTeller::ended(const execute::Outcome& outcome) const {
  for (std::size_t i = 0; i < outcome.limits.size(); ++i) {
    const plan::Limit& limit = plan_.limits[i];
    const execute::LimitRecord& seen = outcome.limits[i];
    if (seen.violations == 0 || limit.on_violation == graph::OnViolation::stop) continue;
    services_.log("limits", BF_LOG_INFO,
                  fmt::format("{}: {} of {} samples {} {}", limit.signal, seen.violations, seen.samples, what_they_did(limit),
                              plan::bounds_text(limit)));
  }
}

void LimitTeller::swept(const std::vector<nlohmann::json>& runs) const {
  for (std::size_t i = 0; i < plan_.limits.size(); ++i) {
    const plan::Limit& limit = plan_.limits[i];
    std::vector<std::size_t> violated;
    for (std::size_t run = 0; run < runs.size(); ++run)
      if (i < runs[run].size() && runs[run][i].value("violations", std::uint64_t{0}) > 0) violated.push_back(run);
    if (violated.empty()) continue;
    const nlohmann::json& seen = runs[violated.front()][i];
    nlohmann::json details = seen.value("first", nlohmann::json::object());
    for (const char* key : {"signal", "unit", "on_violation"}) details[key] = seen.value(key, "");
    details["phase"] = phase_.name;
    details["repeat"] = repeat_;
    details["run"] = violated.front();
    details["runs"] = violated.size();
    directory_.event("limit violated", std::move(details));
    services_.log("limits", BF_LOG_WARNING,
                  fmt::format("{}: in {} of the {} runs of the sweep samples {} {}; in run {} it was {} of {}", limit.signal,
                              violated.size(), runs.size(), what_they_did(limit), plan::bounds_text(limit), violated.front(),
                              seen.value("violations", std::uint64_t{0}), seen.value("samples", std::uint64_t{0})));
  }
}

}  // namespace bodeflow::phases
