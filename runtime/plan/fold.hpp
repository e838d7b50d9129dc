#pragma once

#include "plan/plan.hpp"

namespace bodeflow::plan {

/// `times` repeats of a part of a schedule.
struct Fold {
  std::int64_t times = 1;
  std::vector<Firing> firings;
};

/// The schedule of a loop in a form short enough to read: repeated parts stand once.
std::vector<Fold> fold_schedule(const std::vector<Firing>& schedule);

}  // namespace bodeflow::plan
