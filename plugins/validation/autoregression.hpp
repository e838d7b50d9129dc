#pragma once

#include <Eigen/Core>

namespace bodeflow::validation {

/// Noise as white noise through an all-pole filter: e[n] = -a1 e[n-1] - ... - ap e[n-p] + w[n], with p the number of
/// coefficients and the standard deviation of w.
struct Autoregression {
  Eigen::VectorXd coefficients;  ///< a1 ... ap; none: white noise
  double std = 0.0;
};

/// The autoregression fitted to a record with zero mean, of the order up to `most` with the least corrected criterion of Akaike.
///
/// Method: Burg's recursion, whose models are stable and hardly biased for short records; AICc = N ln s^2 + 2 (p + 1) N / (N - p
/// - 2) over the orders. Orders stay below a tenth of the samples. Cost: O(samples most).
/// References: J. P. Burg, Maximum entropy spectral analysis, thesis, Stanford 1975; C. M. Hurvich, C.-L. Tsai, Biometrika 76,
/// 1989, doi:10.1093/biomet/76.2.297.
Autoregression fit_autoregression(const Eigen::VectorXd& record, Eigen::Index most);

/// What is known of each sample `steps` >= 1 samples before: entry n is the prediction of record[n] from record[0 .. n - steps].
/// The first entries, with fewer than p samples before them, take those that there are (as if zeros had come before).
Eigen::VectorXd predict(const Autoregression& noise, const Eigen::VectorXd& record, Eigen::Index steps);

/// The standard deviation of the error of a `steps`-step prediction: std sqrt(sum over i < steps of psi_i^2), where psi is the
/// impulse response of the filter.
double prediction_deviation(const Autoregression& noise, Eigen::Index steps);

}  // namespace bodeflow::validation
