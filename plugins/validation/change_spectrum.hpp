#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <string>
#include <vector>

#include "change_lines.hpp"

namespace bodeflow::validation {

enum class Verdict { unchanged, changed, undecidable };

/// "unchanged", "changed", "not decidable".
std::string verdict_text(Verdict verdict);

/// What one band of lines says.
struct BandChange {
  double low_hz = 0.0, high_hz = 0.0;  ///< edges
  Eigen::Index first = 0, lines = 0;
  double relative = 0.0;      ///< root of the sum of |change|^2 over that of |before|^2
  double probability = 1.0;   ///< of as much or more where nothing has changed; NaN where no variance is known
  double strongest_hz = 0.0;  ///< the line that is least likely
  double correlation = 0.0;   ///< correlation_coefficient of the magnitudes in dB
  double factor = 0.0;        ///< relative_factor
  double detectable = 0.0;    ///< relative change at all lines that is found with 95 %; NaN where no variance is known
  Verdict verdict = Verdict::undecidable;
};

struct SpectrumChange {
  Eigen::VectorXd significance;  ///< -ln of the probability of as much at that line where nothing has changed
  std::vector<BandChange> bands;
  double level = 0.0;  ///< probability below which a band has changed
  Verdict verdict = Verdict::undecidable;
};

struct SpectrumSettings {
  std::vector<double> edges_hz;  ///< of the bands, rising; empty: `bands` with as many lines each
  Eigen::Index bands = 6;
  double confidence = 0.99;  ///< of all bands and entries together
  double relevant = 0.1;     ///< relative change of a band that must not be missed
};

/// The lines from `first` on: the probability of as much change where nothing has changed.
///
/// Method: t = |change|^2 / variance is F(2, 2 nu) distributed, so e = nu ln(1 + t / nu) is exactly exponential, and the sum of 2
/// e over n independent lines chi-squared with 2 n degrees of freedom (Fisher). Lines that go along with each other leave 2 n /
/// g: g = 2 correlated_lines + 1 for the noise, and as many as there are lines for the scatter of repeat tests, by the shares of
/// both in the variance.
double change_probability(const ChangeLines& lines, const Eigen::VectorXd& significance, Eigen::Index first, Eigen::Index count);

/// How much has changed, band by band: by all lines together, and by the least likely of them (each at half of the level).
/// A band in which nothing is found counts as unchanged only where a change of `relevant` would have been found.
/// entries: of the response, among which the level is shared. Errors: edges that do not rise, no band with lines.
Expected<SpectrumChange> spectrum_change(const ChangeLines& lines, const SpectrumSettings& settings, Eigen::Index entries);

}  // namespace bodeflow::validation
