#pragma once

#include <complex>
#include <vector>

namespace bodeflow::spectrum {

/// A complex number with the estimate of E|dG|^2 and its degrees of freedom nu (infinity: known).
struct Uncertain {
  std::complex<double> value;
  double variance = 0.0;
  double degrees_of_freedom = 0.0;
};

/// The inverse-variance weighted mean of at least one number, see merge.hpp.
Uncertain weighted_mean(const std::vector<Uncertain>& numbers);

/// The probability that two estimates of one number differ by at least as much as these do; 1 for equal ones, 0 for exact ones
/// that differ.
double agreement(const Uncertain& a, const Uncertain& b);

}  // namespace bodeflow::spectrum
