#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bodeflow::sanathanan_koerner {

/// How an iteration went and why it ended.
struct Course {
  std::vector<double> errors;  ///< of each iterate: weighted residual over the weighted data
  int best = -1;               ///< index of the least of them
  bool converged = false;
  std::string reason;

  double least() const { return errors.at(static_cast<std::size_t>(best)); }
};

struct StopRule {
  int iterations = 30;
  double tolerance = 1e-8;  ///< relative change of the error from one iterate to the next that counts as none
  int patience = 6;         ///< iterates without one that is better by kWorthwhile
};

/// Takes the error of the next iterate: true where it is the best so far.
bool note(Course& course, double error);

/// Why the iteration should end now; nothing: go on. Sets `converged` and `reason`.
bool should_stop(Course& course, const StopRule& rule);

}  // namespace bodeflow::sanathanan_koerner
