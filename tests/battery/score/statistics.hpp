#pragma once

#include <vector>

namespace battery {

/// Probability that uniform numbers differ from uniform as much (Kolmogorov and Smirnov, with Stephens' correction for few).
double uniform_probability(std::vector<double> values);

/// The middle one; NaN where there is none.
double median(std::vector<double> values);

/// The upper end of the one-sided 95 % interval (Clopper and Pearson) of a rate of which `count` of `all` were seen.
double upper_rate(int count, int all);

}  // namespace battery
