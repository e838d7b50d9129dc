#pragma once

#include <Eigen/Core>
#include <vector>

#include "search.hpp"

namespace bodeflow::maximum_likelihood {

/// How the errors of neighbouring lines go together. Taken is the mean over all lines, so that the noise of single products
/// hardly counts, as it does in sums of the scores themselves (W. K. Newey, K. D. West, Econometrica 55, 1987,
/// doi:10.2307/1913610).
struct LineCorrelation {
  /// E r_k,i conj(r_(k+l),j), outputs x outputs, for l = 0 .. the distance from which on lines are independent; r: normalised
  /// residuals, turned to the directions of the errors of G. Empty: all lines are independent.
  std::vector<Eigen::MatrixXcd> lags;

  bool any() const { return lags.size() > 1; }
  /// 1 + 2 sum_l |R_l|^2 / |R_0|^2: so many lines are worth one, where powers are summed up.
  double lines_of_one() const;
};

/// The correlation that the residuals show up to that distance; empty for distance 0, or fewer than 4 lines a lag.
LineCorrelation line_correlation(const Lines& lines, const Structure& structure, const Estimate& estimate, Eigen::Index distance);

/// S = Re sum_k,l J_k^H R_(k-l) J_l / 2: the covariance of the gradients for such residuals; slopes: lines after lines, output by
/// output, as jacobian gives them. lags: how many of the correlation's are taken.
Eigen::MatrixXd score_covariance(const Lines& lines, const Structure& structure, const Estimate& estimate,
                                 const LineCorrelation& correlation, std::size_t lags, const Eigen::MatrixXcd& slopes);

/// How many times larger the mean square of a parameter's score is than it were for independent lines; at least 1.
double score_inflation(const Lines& lines, const Structure& structure, const Estimate& estimate,
                       const LineCorrelation& correlation);

}  // namespace bodeflow::maximum_likelihood
