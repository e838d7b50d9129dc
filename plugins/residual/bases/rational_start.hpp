#pragma once

#include <bodeflow/plant.hpp>
#include <span>
#include <vector>

namespace bodeflow::residual {

/// A stable rational function near measured responses.
struct RationalStart {
  std::vector<double> numerator;  ///< ascending powers of x = s / unit
  /// p, q of each section x^2 + p x + q, then r of x + r for an odd order; all above 0.
  std::vector<double> sections;
};

/// Method: linear least squares of w (G D - N) / D', reweighted with the denominator D' of the round before (C. K. Sanathanan, J.
/// Koerner, Transfer function synthesis as a ratio of two complex polynomials, IEEE Trans. Automatic Control 8, 1963); poles of
/// the right half plane are reflected, and N is fitted again. Throws Failure for fewer values than coefficients or a result that
/// is not finite.
RationalStart rational_start(std::span<const MeasuredResponse> measured, int order, int numerator_order, double unit_rad_s);

}  // namespace bodeflow::residual
