#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodeflow::spectrum {

/// A resonance in a frequency response.
struct Peak {
  Eigen::Index row = 0;      ///< of its line
  double width_lines = 0.0;  ///< 3 dB bandwidth, in rows
};

/// The peaks of |G| in one column of a response whose 3 dB bandwidth is below `width_lines` rows, in order. Only those that are
/// well above their uncertainty: the fall to the 3 dB points is at least four standard deviations of the peak. response,
/// variance: one value a line, lines equally spaced.
std::vector<Peak> narrow_peaks(const Eigen::Ref<const Eigen::VectorXcd>& response,
                               const Eigen::Ref<const Eigen::VectorXd>& variance, double width_lines);

}  // namespace bodeflow::spectrum
