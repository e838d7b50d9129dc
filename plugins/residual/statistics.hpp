#pragma once

/// Distributions for the tests of residuals.
namespace bodeflow::residual {

/// The probability that a ratio of two independent mean squares with d1 and d2 degrees of freedom (F distribution, d1, d2 > 0,
/// not necessarily whole; d2 infinite: the lower one is known) is above `value`; 1 for values at or below 0.
double f_tail(double value, double d1, double d2);

/// The value that such a ratio exceeds with `probability` in (0, 1): the inverse of f_tail.
double f_limit(double probability, double d1, double d2);

/// The value that a standard normal deviate exceeds with `probability` in (0, 1).
double normal_limit(double probability);

}  // namespace bodeflow::residual
