#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace bodeflow::filters {

/// y[factor m + p] = sum_j h[factor j + p] x[m - j], p = 0 .. factor - 1, on one channel: zeros between the samples, then h,
/// computed without the products with zeros.
class Interpolator {
 public:
  /// h: coefficients at the higher rate; max_inputs: most inputs of one `run`. Allocates all that is needed.
  Interpolator(std::span<const double> h, std::size_t factor, std::size_t max_inputs);

  /// Gives factor x.size() samples, x.size() <= max_inputs. The sum of each output has one fixed order, whatever the calls'
  /// sizes.
  void run(std::span<const double> x, std::span<double> y);

  /// Back to a past of zeros.
  void reset();

 private:
  std::size_t factor_;
  std::size_t taps_;            // of a phase
  std::vector<double> phases_;  // phase after phase, each backward in time
  std::vector<double> frame_;   // the last taps - 1 samples, then those of the call
};

}  // namespace bodeflow::filters
