#pragma once

#include "sampled/stretch.hpp"

namespace bodeflow::residual {

/// Noise as white noise through an all-pole filter: e[n] = -a1 e[n-1] - ... - ap e[n-p] + w[n].
struct NoiseModel {
  Eigen::VectorXd coefficients;  ///< a1 ... ap; none: white noise
  double variance = 0.0;         ///< of w
};

/// The autoregression of that order fitted to a residual.
///
/// Method: Burg's recursion over all stretches together, which gives stable models that are hardly biased for short records; the
/// prediction errors of the first samples of a stretch, which have too few before them, do not count. Orders end where a
/// stretch would be shorter than twice the order. Cost: O(rows order).
/// Reference: J. P. Burg, Maximum entropy spectral analysis, thesis, Stanford 1975.
NoiseModel fit_noise(const Eigen::VectorXd& residual, const Stretches& stretches, Eigen::Index order);

/// The order from 0 to `most` with the least criterion of Akaike, corrected for short records.
/// Reference: C. M. Hurvich, C.-L. Tsai, Biometrika 76 (1989) 297, doi:10.1093/biomet/76.2.297.
Eigen::Index noise_order(const Eigen::VectorXd& residual, const Stretches& stretches, Eigen::Index most);

/// w of the model: what of each row the rows before it do not tell. The first `order` rows of each stretch are left out, so
/// the result has as many rows less for each.
Eigen::MatrixXd innovations(const NoiseModel& noise, const Eigen::MatrixXd& rows, const Stretches& stretches);

/// n ln(s0^2 / s1^2): by how much minus twice the log likelihood falls from one residual to another of the same rows. Both get
/// a noise model of the same order, the greater one of what suits each.
double likelihood_gain(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const Stretches& stretches);

}  // namespace bodeflow::residual
