#pragma once

#include <functional>
#include <string>
#include <vector>

namespace bench {

/// What one run cost. CPU is user and system time of the whole process while it ran.
struct Cost {
  double cpu_ns = 0.0;   ///< per sample
  double wall_ns = 0.0;  ///< per sample
};

/// CPU and wall time of a call, per sample.
Cost measure(std::size_t samples, const std::function<void()>& call);

/// Nanoseconds on the steady clock.
double now_ns();

double median(std::vector<double> values);
double quantile(std::vector<double> values, double q);

}  // namespace bench
