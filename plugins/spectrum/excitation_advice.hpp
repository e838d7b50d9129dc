#pragma once

#include <bodeflow/facts.hpp>
#include <string>
#include <vector>

#include "estimate.hpp"
#include "experiment_schedule.hpp"

namespace bodeflow::spectrum {

/// A measurement with averaged periods before it is made.
struct Planned {
  Schedule schedule;  ///< with the number of experiments
  LineChoice choice;
  Form form = Form::errors_in_variables;
  bool remove_transient = false;
};

struct Remark {
  bool warning = false;
  std::string text;
};

/// What can be said of it from what is known of the streams (their notes): time and whole periods; whether the period is that of
/// the excitation; the excited band beside the Nyquist frequency, the lines asked for and the plant's modes; settling time beside
/// the skipped periods; crest factor; the standard deviation of |G| that the noise lets expect, and what four times the periods
/// would give.
///
/// With white noise of standard deviation s on the output, E|dG|^2 = 4 s^2 / (a^2 N P) at a line of peak value a: var Y_p = s^2 /
/// N, |U| = a / 2 (N P E M for E orthogonal experiments and M realisations). Half of it lies along G, so std |G| = sqrt(2) s / (a
/// sqrt(N P)), what is told here and what a run tells. Noise s_u on the input adds |G| s_u in quadrature to s. excitation: the
/// reference where there is one, else the input.
std::vector<Remark> measurement_advice(const Planned& planned, const StreamFacts& excitation, const StreamFacts& input,
                                       const StreamFacts& output);

/// The lines of a period of N samples that a stream's notes say are excited, rising; empty where they say nothing. Frequencies
/// between lines are left out.
std::vector<std::int64_t> excited_lines(const StreamFacts& excitation, std::int64_t period);

}  // namespace bodeflow::spectrum
