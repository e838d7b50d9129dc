#pragma once

#include <string>
#include <vector>

#include "sampled/stretch.hpp"

namespace bodeflow::residual {

/// A residual against past or future values of a signal.
struct Correlation {
  double p = 1.0;        ///< of all lags together
  double largest = 0.0;  ///< of the lags: correlation coefficient with its sign
  Eigen::Index lag = 0;  ///< where: the signal stands that many rows before the residual (below 0: behind it)
};

/// What a residual has to do with itself and with the input.
struct Correlations {
  double whiteness_p = 1.0;  ///< that white noise has such correlations with itself
  double colour = 1.0;       ///< root mean square of the residual over that of its innovations
  Correlation input;         ///< e and u[n - lag], lags 0 .. L: linear dynamics that the model lacks
  Correlation input_square;  ///< e^2 and u^2[n - lag], lags 0 .. L: nonlinear effects, noise that grows with the input
  Correlation future;        ///< e and u[n + lag], lags 1 .. L: feedback from the output to the input
};

/// The tests of one residual, all in rows.
///
/// Method: the residual and the lagged inputs pass the inverse of the residual's noise model (autoregression of order up to 10
/// by Akaike's criterion), which leaves white noise where nothing is missing. Whiteness is the portmanteau of Ljung and
/// Box of the unfiltered residual, L lags. The others are joint tests: the white residual is regressed on the inputs at all lags
/// together; the share it explains is F distributed, whatever the spectrum of the input. `jacobian` (rows x parameters, may
/// be empty) spans what the fit has taken out of the residual, or what its uncertainty puts in: those directions are taken out of
/// both sides. Squares: of the white residual, on the squares of the unfiltered input, means taken off; the variance of the
/// squares is that of the sample. Lags: 20, fewer for short stretches. Cost: O(rows L^2). References: L. Ljung, System
/// Identification: Theory for the User, 2nd ed. 1999, section 16.6; G. M. Ljung, G. E. P. Box, Biometrika 65 (1978) 297; S. A.
/// Billings, Q. M. Zhu, Nonlinear model validation using correlation tests, Int. J. Control 60 (1994) 1107.
Correlations correlate(const Eigen::VectorXd& residual, const Eigen::VectorXd& input, const Eigen::MatrixXd& jacobian,
                       const Stretches& stretches);

}  // namespace bodeflow::residual
