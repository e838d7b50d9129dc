#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <vector>

#include "records.hpp"

namespace bodeflow::spectrum {

/// One response beside those at smaller amplitudes.
struct LevelComparison {
  double p_value = 1.0;              ///< that noise alone makes the responses differ as much, in one of both ways
  double lines_p_value = 1.0;        ///< line by line: what differs at some lines only
  double smooth_p_value = 1.0;       ///< mean relative differences of groups of lines: what changes slowly over frequency
  Eigen::VectorXd line_p_value;      ///< the same at each line; of several entries the least, times their number
  double relative_difference = 0.0;  ///< rms over the lines, what noise explains taken off, over the rms response
  double relative_noise = 0.0;       ///< what noise explains, likewise
};

/// How far a plant is linear, from responses at several amplitudes.
struct Linearity {
  std::vector<std::size_t> order;            ///< of the responses, by amplitude
  std::vector<double> amplitudes;            ///< rising
  std::vector<LevelComparison> comparisons;  ///< of all levels but the smallest
  std::size_t linear_levels = 1;             ///< so many, from the smallest on, agree; 1: already the second differs
  double p_value = 1.0;                      ///< of the first level that differs, or the least of all

  bool linear() const { return linear_levels == amplitudes.size(); }
  /// The largest amplitude up to which all levels agree; the smallest one where none does.
  double largest_linear() const { return amplitudes[linear_levels - 1]; }
};

/// Whether frequency responses at different amplitudes agree within their noise, level by level against the weighted mean of
/// those below it, until one differs.
///
/// Test: at each line |G - G_0|^2 / (v + v_0) ~ F(2, 2 nu), nu after Satterthwaite, whose tail is a probability p_k; -2 sum ln
/// p_k ~ chi-squared with two degrees a line (R. A. Fisher), exact for any number of periods as long as the lines are
/// independent. A level differs where that has a probability below significance / (levels - 1). Blind to what is alike at all
/// levels: a constant bias moves the operating point and looks linear, a dead time at amplitudes far above or far below its own
/// voltage changes little. Agreement says that a difference is below the noise, see relative_noise. Reference: R. A. Fisher,
/// Statistical Methods for Research Workers, 4th ed. 1932, section 21.1.
///
/// amplitudes: one a response, all apart. Errors: fewer than 2 responses; a variance that is absent; lines, inputs, outputs or
/// units that differ from the first one's; amplitudes that are not positive or not apart; significance outside 0 .. 1.
Expected<Linearity> linearity(const std::vector<ResponseData>& responses, const std::vector<double>& amplitudes,
                              double significance);

/// The amplitude of a measurement: the rms over its lines of their peak values, 2 |U_k| of spectra scaled by 1/N. Errors: no mean
/// spectra.
Expected<double> line_amplitude(const ResponseData& response);

}  // namespace bodeflow::spectrum
