#include "phases/limits.hpp"

#include <fmt/format.h>

#include "record/limits.hpp"

namespace bodeflow::phases {

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
    services_.log(
        "limits", BF_LOG_INFO,
        fmt::format("{}: {} of {} samples {} {}", limit.signal, seen.violations, seen.samples,
                    limit.on_violation == graph::OnViolation::clamp ? "were held within" : "left", plan::bounds_text(limit)));
  }
}

}  // namespace bodeflow::phases
