#pragma once

#include <Eigen/Core>
#include <vector>

#include "windows.hpp"

namespace bodeflow::frisch {

/// The noise variances of the frequency-domain Frisch scheme: E|dU|^2 and E|dY|^2 of one window, the same at all lines.
struct NoiseVariances {
  double input = 0.0;
  double output = 0.0;
  double cost = 0.0;  ///< sum over the lines of det(Phi_k - diag(input, output))
};

/// The variances that leave the least sum of determinants while every Phi_k - diag(input, output) stays positive semidefinite:
/// the bilinear matrix inequality (15) of the paper with x3 = x1 x2 (as printed, with epsilon weighted by 1 against K times x3,
/// it is unbounded below).
///
/// Method, exact and global: with a = uu_k, b = yy_k, c = |yu_k|^2 feasible points lie under the lower envelope of the arcs
/// h_k(x) = b_k - c_k/(a_k - x), and the cost K (mean a - x1)(mean b - x2) + const falls with x2, so the minimum stands on the
/// envelope. It is walked from x1 = 0 to where it meets x2 = 0; each arc adds its ends and the one stationary point that can be a
/// minimum. Two arcs cross at roots of a quadratic. Cost: O(lines) an arc of the envelope, of which there are few.
///
/// Biased: the least of all lines' arcs bounds the variances, so they come out too small (to .4 in one direction with 24 lines
/// and 8 windows), and where |G| hardly changes over the lines the two are badly determined, each on its own. Where there are
/// repeated periods use pooled_noise; the scheme is for records without. Reference: P. Castaldi, M. Montanari, A. Tilli,
/// "Induction motor model identification via frequency-domain Frisch scheme", 2002; S. Beghelli, P. Castaldi, U. Soverini, ECC
/// 1997. Errors: no line; sizes that differ; a value that is not finite; a power that is not above 0 (named); |yu|^2 above uu yy.
Expected<NoiseVariances> noise_variances(const PowerSpectra& spectra);

/// det(Phi_k - diag(input, output)) at each line.
Eigen::VectorXd determinants(const PowerSpectra& spectra, const NoiseVariances& noise);

/// How lines are ranked for removal; the paper says "determinant closest to zero" and leaves the scale open.
enum class OutlierMeasure {
  determinant,  ///< |det|
  relative      ///< |det| / (trace Phi)^2, which does not grow with the power of a line
};

/// Both passes of the paper: the variances from all lines, and again without the lines whose matrix is then nearest to singular.
struct FrischNoise {
  NoiseVariances first;
  NoiseVariances second;
  std::vector<Eigen::Index> removed;  ///< ascending
};

/// fraction: of the lines to remove, rounded to whole lines (the paper: .08, 2 of 24). It makes up for part of the
/// underestimation; .25 or .5 makes up for more, there is nothing special in .08.
/// Errors: those of noise_variances; a fraction that leaves no line or is not within 0 .. 1.
Expected<FrischNoise> frisch_noise(const PowerSpectra& spectra, double fraction = 0.08,
                                   OutlierMeasure measure = OutlierMeasure::determinant);

}  // namespace bodeflow::frisch
