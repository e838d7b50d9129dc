#pragma once

#include <vector>

#include "sampled/stretch.hpp"
#include "trace/residual_views.hpp"

namespace bodeflow::residual {

/// Bins of conditional means.
inline constexpr Eigen::Index kMapBins = 24;
/// Lags of an autocorrelation, from 1 on.
inline constexpr Eigen::Index kViewedLags = 40;
/// Half of the 95 % band of a standard normal deviate.
inline constexpr double kBand95 = 1.959963984540054;

/// The rows by the value of a signal, smallest first, in at most 24 bins of equally many (at least 4 each); equal values stay
/// together, so that there may be fewer bins.
std::vector<std::vector<Eigen::Index>> bins_by_value(const Eigen::VectorXd& signal);

/// The slope of a signal by the second: central differences within each stretch, one-sided at its ends.
Eigen::VectorXd slope_of(const Eigen::VectorXd& signal, double step_s, const Stretches& stretches);

/// The conditional mean of a residual, by bins of a signal.
///
/// Standard errors allow for a residual that is correlated over time: the variance of a bin's sum is the sum of the products of
/// all pairs up to L rows apart, weighted 1 - lag / (L + 1), with L = 1.5 rows^(1/3). Reference: W. K. Newey, K. D. West,
/// Econometrica 55 (1987) 703. Cost: O(rows L).
MeanMap mean_map(const Eigen::VectorXd& residual, const Eigen::VectorXd& signal);

/// Root mean square by at most 40 blocks of rows, over the times of the rows.
ResidualCourse course_by_blocks(const Eigen::VectorXd& residual, const Eigen::VectorXd& time_s);

/// sum e[n] e[n + lag] / sum e[n]^2 of pairs within a stretch; at most a quarter of the shortest stretch. The mean is not taken
/// off: a right model leaves none.
Autocorrelation autocorrelation(const Eigen::VectorXd& residual, double step_s, const Stretches& stretches);

}  // namespace bodeflow::residual
