#pragma once

#include <limits>
#include <string>
#include <vector>

#include "score/score.hpp"

namespace battery {

/// What is asked of a tracer; what is not asked is not judged.
struct Limits {
  int false_alarms = std::numeric_limits<int>::max(), wrong_names = std::numeric_limits<int>::max();
  int outside = std::numeric_limits<int>::max(), leaks = std::numeric_limits<int>::max(),
      failed = std::numeric_limits<int>::max();
  double coverage_low = 0.0, coverage_high = 1.0;
  double uniformity = 0.0;    ///< least probability of Kolmogorov and Smirnov over all clean p-values
  double silent_share = 0.0;  ///< of effects below the limit of detection: share without a wrong name
  double named_share = 0.0;   ///< of visible effects
};

/// One line of the list of what was asked.
struct Check {
  std::string what, found, asked;
  bool passed = true;
};

std::vector<Check> checks_of(const Score& s, const Limits& limits, double limit, double visible);

/// The report in Markdown: checks, confusion matrix, sizes, parameters, p-values, and every case that was not answered rightly.
std::string report(const std::vector<Judged>& cases, const Score& s, const std::vector<Check>& checks);

}  // namespace battery
