#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "line_correlation.hpp"
#include "rational.hpp"
#include "search.hpp"

namespace bodeflow::maximum_likelihood {

/// Where the covariance comes from.
enum class CovarianceKind {
  /// The inverse Fisher information, from the variances of the data: right where the model holds.
  information,
  /// The sandwich H^-1 (sum_k g_k g_k^T) H^-1 of the gradients of the lines: from the scatter of the residuals, right also where
  /// variances, or correlations between outputs, are other than told. What the model misses counts as if it were drawn anew at
  /// each line; it says how well the best model of this order is known, not how far that is from the truth.
  residuals,
};

/// R with covariance R R^T of theta and, in the last row, of the delay.
///
/// Information with variances of nu degrees of freedom: times nu/(nu - 2), since lines weigh by chance (factor (P - 1)/(P - 3)
/// for P periods; to be had for nu > 2). Residuals: times F/(F - n/2) for n parameters at F complex equations.
/// With `correlation` the residuals' sum is score_covariance, raised in directions where it is below that of independent lines,
/// times (nu - 1)/(nu - 2), since the weights of lines scatter, which their mean correlation does not hold, and times
/// F/(F - (2 d + 1) n/2) for a distance d, at most 2: of the slow errors, which only F/(2 d + 1) equations tell, the fit has
/// taken n/2 away.
///
/// References: R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, sections 9.12 and
/// 12.3; L. Ljung, System Identification, 2nd ed. 1999, section 9.4 (sandwich).
/// Errors: data that leave a combination of the parameters free (smallest singular value below 1e-10 of the largest).
Expected<Eigen::MatrixXd> covariance_root(const Lines& lines, const Structure& structure, const Estimate& estimate,
                                          CovarianceKind kind, double degrees_of_freedom,
                                          const LineCorrelation& correlation = {});

/// The coefficients of one output's model with their covariance.
struct Coefficients {
  std::vector<std::string> names;  ///< b_m .. b_0, a_(n-1) .. a_0, delay where it is estimated
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;
};
Coefficients coefficients_of(const Lines& lines, const Structure& structure, const Estimate& estimate, std::size_t output,
                             const Rational& rational, const Eigen::MatrixXd& root);

/// Derivatives of roots by theta, a row a root of `rational`: those of fixed poles are 0.
Eigen::MatrixXcd pole_slopes(const Lines& lines, const Structure& structure, const Estimate& estimate, const Rational& rational);
Eigen::MatrixXcd zero_slopes(const Lines& lines, const Estimate& estimate, std::size_t output, const Rational& rational);

/// Covariance of real and imaginary part for a row of slopes.
Eigen::Matrix2d root_covariance(const Eigen::RowVectorXcd& slope, const Eigen::MatrixXd& root);

}  // namespace bodeflow::maximum_likelihood
