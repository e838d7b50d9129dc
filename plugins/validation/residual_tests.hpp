#pragma once

#include <Eigen/Core>

namespace bodeflow::validation {

/// Correlations of a residual, normalised to lie within -1 and 1, with what chance leaves of them.
struct ResidualTests {
  Eigen::VectorXd autocorrelation;      ///< lags 0 ... L; 1 at lag 0
  double autocorrelation_band = 0.0;    ///< white noise stays within +- this at a lag, with the confidence asked for
  double whiteness_probability = 1.0;   ///< that white noise has autocorrelations this great, all lags together
  Eigen::VectorXd cross_correlation;    ///< of e[n + lag] and u[n], lags -L ... L
  double cross_correlation_band = 0.0;  ///< the same for a residual that has nothing to do with the input
  Eigen::Index cross_outside = 0;       ///< lags 0 ... L beyond the band
};

/// The tests of a residual against itself and against the input, both of the same length; means are taken off.
///
/// Autocorrelation: r(k) sqrt(N) is normal with variance 1 for white noise; all lags together by Q = N (N + 2) sum r(k)^2 / (N -
/// k), chi-squared with L - `fitted` degrees of freedom, `fitted` being the coefficients of a noise model that was fitted to
/// it. Cross-correlation: sqrt(N) r_eu(k) is normal with variance P = sum over all lags of r_e(k) r_u(k), so the residual may be
/// coloured. Positive lags: the model lacks something of how the output follows the input. Negative lags alone: feedback from
/// output to input. Noise on the measured input correlates, too, around lag 0. A residual or input that is constant has no
/// correlation. lags: at least 1 and below the length. Cost: O(N log N + N lags).
/// References: L. Ljung, System Identification: Theory for the User, 2nd ed. 1999, section 16.6; G. M. Ljung, G. E. P. Box,
/// Biometrika 65, 1978, doi:10.1093/biomet/65.2.297.
ResidualTests test_residual(const Eigen::VectorXd& residual, const Eigen::VectorXd& input, Eigen::Index lags, Eigen::Index fitted,
                            double confidence);

}  // namespace bodeflow::validation
