#pragma once

/// The chi-squared distribution, for tests of residuals and costs.
namespace bodeflow::numerics {

/// The probability that a chi-squared variable with `degrees_of_freedom` > 0 (not necessarily whole) is above `value`; 1 for
/// values at or below 0. Relative accuracy about 1e-13 down to the smallest doubles.
double chi_squared_tail(double value, double degrees_of_freedom);

/// The value that a chi-squared variable exceeds with `probability` in (0, 1): the inverse of chi_squared_tail.
double chi_squared_limit(double probability, double degrees_of_freedom);

}  // namespace bodeflow::numerics
