#pragma once

#include <vector>

#include "equations.hpp"

namespace bodeflow::maximum_likelihood {

/// One way of getting a start without one: iterated linear least squares.
struct LinearMethod {
  /// Weights of the first iteration: those of A = 1 (Levy), or of A = (1 + x)^n, which does not let the highest lines decide.
  bool rolled_off = false;
  /// Weights 1/spread^relaxation of the iteration before; 1 is that of Sanathanan and Koerner, less converges where that jumps.
  double relaxation = 1.0;
  /// Least squares with the norm of the coefficients fixed, or with the variance that noise gives to sum |A Y - B U|^2 / spread
  /// fixed (bootstrapped total least squares), which is free of bias but needs the noise.
  bool total = false;
};

/// The methods in the order in which they are tried.
const std::vector<LinearMethod>& linear_methods();

/// The model of least cost that so many iterations met with the delay given; its bases are those of that iteration's weights.
///
/// Each iteration solves sum_k |A Y - B U exp(-s delay)|^2 / spread_before^relaxation -> min.
/// References: E. C. Levy, IRE Trans. Automatic Control 4 (1959) 37; C. K. Sanathanan, J. Koerner, IEEE Trans. Automatic Control
/// 8 (1963) 56; R. Pintelon, J. Schoukens, System Identification: A Frequency Domain Approach, 2nd ed. 2012, sections 9.8 and
/// 9.11.
/// Errors: those of bases_for and free_directions; no iteration with a finite cost.
Expected<Estimate> linear_start(const Lines& lines, const Structure& structure, double delay_s, const LinearMethod& method,
                                int iterations);

}  // namespace bodeflow::maximum_likelihood
