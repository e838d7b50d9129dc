#pragma once

#include <bodeflow/error.hpp>
#include <cstdint>
#include <vector>

#include "moments.hpp"

namespace bodeflow::spectrum {

/// Which lines an estimate has.
struct LineChoice {
  /// Line numbers 1 .. (N-1)/2, rising; empty: all of these.
  std::vector<std::int64_t> candidates;
  /// Above zero: only candidates that are excited, see chosen_lines. Zero: all candidates.
  double threshold = 0.0;
};

/// The lines that `choice` names. With a threshold, those among them that are excited in each realisation: with the power |X|^2
/// summed over the inputs (the references, where there are any) and experiments, |X| is at least `threshold` times the
/// largest |X| among the candidates, and |X|^2 at least ten times the variance of the mean, where that is known.
std::vector<std::int64_t> chosen_lines(const Measured& measured, const LineChoice& choice);

/// Power of the excitation at each line 0 .. N/2 of one realisation: |X|^2 summed over inputs (references where there are any)
/// and experiments; and the variance of the mean, summed likewise, zero where it is unknown.
struct Excitation {
  Eigen::VectorXd power;
  Eigen::VectorXd variance;
};
Excitation excitation_of(const Measured& measured, std::size_t realisation);

}  // namespace bodeflow::spectrum
