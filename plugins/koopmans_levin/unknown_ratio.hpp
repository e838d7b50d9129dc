#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "solution.hpp"

/// The noise ratio, where it is not known.
namespace bodeflow::koopmans_levin {

/// A ratio estimate. `determined` is an answer, not a formality: where it is false the data do not tell the ratio, `reason` says
/// how that showed, and the solution must not be used.
struct RatioEstimate {
  bool determined = false;
  std::string reason;  ///< empty where determined
  double ratio = 0.0;
  double log_ratio_std = 0.0;  ///< standard deviation of ln(ratio)
  double criterion = 0.0;      ///< J at the minimum (covariance matching)
  Eigen::Index lags = 0;       ///< M
  Solution solution;           ///< at `ratio`
  /// Of a_1 .. a_n, b_0 .. b_n, lambda_u, the uncertainty of the ratio included.
  Eigen::MatrixXd covariance;
};

/// The ratio by covariance matching: along the solutions of all ratios, the one whose equation errors have the autocorrelation
/// that white noises would give them.
///   J(ratio) = sum_{m=0}^{M} (r_e(m) - r_m(m))^2 / r_e(0)^2,
///   r_e(m) = mean |eps_k|^2 cos(m w_k),  r_m(m) = mean lambda (ratio |A|^2 + |B|^2) cos(m w_k).
/// A grid over ratios within a factor 100 of mean |Y|^2 / mean |U|^2, then Brent's method. The standard deviation follows from
/// the shares of the lines in all sums (see influence.hpp), the slope of r_e - r_m along the solutions included. Not determined:
/// a minimum at the end of the grid, or a standard deviation of ln(ratio) above ln 2.
///
/// lags: M; where not given n for the full range, otherwise 1.5 * 2 pi / bandwidth, at least 16: shorter lags do not resolve a
/// band. Consistent for white noise; with a strongly coloured input and 1000 samples it fails in some 3 of 100 records, more lags
/// make it worse there. Wherever the noise can be measured (periodic excitation, an empty band), do: ratio_from_output_noise.
/// Reference: T. Soderstrom, Automatica 43 (2007) 939, section 7.
/// Cost: O(lines (n + M)) a ratio, some 60 ratios. Errors: those of `solve` and of Influence; M below 1.
Expected<RatioEstimate> ratio_by_covariance_matching(const Lines& lines, const Factors& factors,
                                                     std::optional<Eigen::Index> lags = std::nullopt);

/// The ratio at which the solution's output noise, ratio * lambda_u (unbiased), is `output_noise`: a variance measured elsewhere,
/// e.g. from the periods of the record or from a band where the response is nearly zero. output_noise_std: standard deviation of
/// that variance, 0 if it is exact. It enters log_ratio_std and the covariance; what the record's own noise adds is taken from
/// the shares of the lines. Not determined: a variance that no ratio within a factor 10,000 of mean |Y|^2 / mean |U|^2 gives, or
/// a standard deviation of ln(ratio) above ln 2. Errors: those of `solve` and of Influence; a variance that is not positive.
Expected<RatioEstimate> ratio_from_output_noise(const Lines& lines, const Factors& factors, double output_noise,
                                                double output_noise_std = 0.0);

/// The variance of white noise in a signal by the lines of a band where the signal itself is nearly zero: mean |X|^2, its bias
/// what is left of the signal. X: unitary transform, as in Lines.
double noise_floor(const Eigen::VectorXcd& spectrum);

}  // namespace bodeflow::koopmans_levin
