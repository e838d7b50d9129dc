#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "records/response.hpp"

namespace bodeflow::validation {

/// One entry of a frequency response before and after, at the lines of the first.
struct ChangeLines {
  Eigen::VectorXd frequency_hz;
  Eigen::VectorXcd before, after;
  Eigen::VectorXd before_noise, after_noise;  ///< variance E|dG|^2 of the measurement; 0 where it is not known
  Eigen::VectorXd scatter;                    ///< variance by which a repeat test differs beyond that noise; 0 where not known
  double before_degrees = INFINITY;           ///< complex degrees of freedom of these variances
  double after_degrees = INFINITY;
  double scatter_degrees = INFINITY;
  std::int64_t correlated_lines = 0;  ///< as in a record `frequency_response`, the larger of both

  Eigen::Index lines() const { return frequency_hz.size(); }
  Eigen::VectorXcd change() const { return after - before; }
  /// E|d(after - before)|^2 and its complex degrees of freedom (Satterthwaite).
  double variance(Eigen::Index k) const { return before_noise[k] + after_noise[k] + 2.0 * scatter[k]; }
  double degrees(Eigen::Index k) const;
};

/// What is known of the scatter of repeat tests: stated, or from responses measured again with nothing changed.
struct Scatter {
  double relative = 0.0;  ///< standard deviation of the complex value over its magnitude
  double absolute = 0.0;
  std::vector<records::ResponseData> repeats;

  bool known() const { return relative > 0.0 || absolute > 0.0 || !repeats.empty(); }
};

/// Two responses made comparable: entry by entry, output * inputs + input.
struct AlignedResponses {
  std::vector<ChangeLines> entries;
  Eigen::Index interpolated = 0;  ///< lines of the first at which the second has been interpolated
  Eigen::Index left_out = 0;      ///< lines of the first outside the range of the second
};

/// Both responses at the lines of the first.
///
/// Method: frequencies within 1e-6 of each other are the same line. Otherwise the second is interpolated by the cubic through the
/// four nearest lines over log f; the square of what a straight line between two of them differs by is added to its variance.
/// Scatter from R repeats: the mean over 2 w + 1 neighbouring lines of the variance of the first and its repeats over that of
/// the noise (over |G|^2 where the noise is not known), less the noise itself, with R degrees of freedom: errors of repeat tests
/// go along with each other from line to line.
/// Errors, by name: numbers of inputs or outputs, or units, that differ; fewer than kFewestLines common lines; repeats at other
/// frequencies; a line at 0 Hz where interpolation is needed.
Expected<AlignedResponses> align(const records::ResponseData& before, const records::ResponseData& after, const Scatter& scatter);

inline constexpr Eigen::Index kFewestLines = 8;

}  // namespace bodeflow::validation
