#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>

namespace bodeflow::spectrum {

/// One response over a band, and how to look at it.
struct DelayProblem {
  Eigen::VectorXd frequency_hz;  ///< rising, above zero, at least 3
  Eigen::VectorXcd response;
  Eigen::VectorXd variance;  ///< E|dG|^2 above zero; empty where it is not known: all lines count alike
  int slope = 0;             ///< m: G falls or rises as (j omega)^m beside the delay
  double largest_s = 0.0;    ///< delays up to here are looked for; 0: half of the inverse of the smallest line spacing
};

/// A delay.
struct DelayEstimate {
  double delay_s = 0.0;
  double standard_deviation_s = 0.0;
  double gain = 0.0;    ///< a, unit of G times s^-m
  double misfit = 0.0;  ///< rms of what the model leaves, in standard deviations; 1 expected. NaN where the variance is not known
  double relative_error = 0.0;  ///< rms of what the model leaves, of the rms of G
  double largest_s = 0.0;       ///< how far was looked
  double rival_s = 0.0;         ///< the delay of the second best minimum, at another peak of the criterion
  double rival_excess = 0.0;    ///< how much worse it is, in the sum of squares in units of its expected noise
};

/// The delay tau of G = a (j omega)^m exp(-j omega tau), a real of either sign, 0 <= tau <= largest_s.
///
/// Minimises J = sum_k w_k |H_k - a exp(-j omega_k tau)|^2, H = G/(j omega)^m, w = 1/var H: for each tau a is
/// Re(sum w H exp(j omega tau)) / sum w; a grid of 16 points a period of the highest frequency, then Gauss-Newton.
///   var tau = s / (2 a^2 sum w omega^2),  s = max(1, J/(K - 1)), or J/(K - 1) without variances.
///
/// It is the maximum-likelihood estimate of a real gain and a delay in circular normal noise, independent from line to line;
/// where neighbouring lines share data (local polynomials at each line) the standard deviation is too small. Wrong where the
/// plant is not a delayed gain (or integrator, by m) over the band: each pole or zero beyond the band adds about its time
/// constant, one inside it shows as a misfit. Lines at a spacing D leave tau open by multiples of 1/D (1/(2D) where the sign of
/// the gain is open too and the lines are odd multiples).
///
/// Reference: G. C. Carter, Coherence and time delay estimation, Proc. IEEE 75 (1987) 236, doi:10.1109/PROC.1987.13723.
///
/// Cost: lines times grid points. Errors: fewer than 3 lines, no response, more than 1e9 evaluations.
Expected<DelayEstimate> delay_of(const DelayProblem& problem);

}  // namespace bodeflow::spectrum
