#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "fit.hpp"
#include "uncertainty.hpp"

namespace bodeflow::maximum_likelihood {

/// A cost beside what it is expected to be where the model is right and the variances are.
struct CostTest {
  double cost = 0.0;
  double expected = 0.0;              ///< (F - n/2) nu/(nu - 1); infinite for nu <= 1
  std::optional<double> deviation;    ///< standard deviation of that; not for nu <= 2
  std::optional<double> probability;  ///< of a greater cost
  double degrees_of_freedom = 0.0;    ///< 2F - n, of 2 cost with nu infinite
};

/// The test of a fit with n parameters at F complex equations, with variances of nu degrees of freedom: |residual|^2 is F(2, 2
/// nu) distributed, so with P periods the expected cost is (P - 1)/(P - 2) (F - n/2), and its variance (P - 1)^3/((P - 2)^2 (P -
/// 3)) (F - n/2). The probability takes the cost as gamma distributed with these moments. Reference: R. Pintelon, J. Schoukens,
/// System Identification: A Frequency Domain Approach, 2nd ed. 2012, sections 9.12 and 10.3.
/// With correlated lines n counts `inflation` times, and the variance is larger by LineCorrelation::lines_of_one.
CostTest cost_test(const Spectra& spectra, const Fit& fit);

/// AIC and MDL, the latter with ln(2F) for each parameter in place of 2: 2 cost + penalty, the cost less the part (nu/(nu - 2))
/// that variances of nu degrees of freedom add to what a parameter wins; with correlated lines a parameter counts `inflation`
/// times (K. Takeuchi 1976). Without known variance 2F ln(cost/F) + penalty.
struct Criteria {
  double aic = 0.0, mdl = 0.0;
};
Criteria criteria(const Spectra& spectra, const Fit& fit);

/// Whether the residuals of one output are independent from line to line. Taken are their directions in the complex plane, r/|r|,
/// so that neither a wrong variance nor a single large error decides: dynamics that the model lacks turn them slowly from line
/// to line, noise does not.
struct Whiteness {
  Eigen::Index lags = 0;
  double statistic = 0.0;    ///< sum over lags l = 1 .. L of 2/(K - l) |sum_k conj(d_k) d_(k+l)|^2; chi-squared with 2L degrees
  double probability = 1.0;  ///< of a greater one
};
/// distance: lines so far apart may be correlated. L multiples of the distance from which on they are not are taken then, and the
/// statistic is divided by 1 + 2 sum_(l <= distance) |mean conj(d_k) d_(k+l)|^2 (M. S. Bartlett 1946).
/// Nothing for fewer than 8 lines, or where an error is 0. The few dimensions that a fit takes away make the test a little
/// timid where lines are few.
std::optional<Whiteness> whiteness(const Eigen::VectorXcd& errors, Eigen::Index distance = 0);

/// A pole and a zero that may be the same: their distance is within its uncertainty (95 %), and below 0.3 of the larger of them.
struct Cancellation {
  std::complex<double> pole, zero;  ///< rad/s or z; of a pair the upper one
  std::size_t output = 0;
};
std::vector<Cancellation> cancellations(const Fit& fit, const Eigen::MatrixXd& covariance_root);

/// A pole outside the stable region, and by how many of its standard deviations (infinite without covariance).
struct UnstablePole {
  std::complex<double> pole;
  double deviations = 0.0;
};
std::vector<UnstablePole> unstable_poles(const Fit& fit, const Eigen::MatrixXd& covariance_root);

}  // namespace bodeflow::maximum_likelihood
