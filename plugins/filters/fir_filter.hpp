#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace bodeflow::filters {

/// y[n] = sum_j h[j] x[n - j], j in rising order, on one channel. The same bits whatever the calls' sizes and the vector level.
class FirFilter {
 public:
  /// h: at least one coefficient; max_count: most samples of one `run`. Allocates all that is needed.
  FirFilter(std::span<const double> h, std::size_t max_count);

  /// x.size() == y.size() <= max_count; y may be x.
  void run(std::span<const double> x, std::span<double> y, int vector_level);

  /// Back to a past of zeros.
  void reset();

 private:
  std::vector<double> h_;
  std::vector<double> frame_;  // the last h.size() - 1 samples, then those of the call
};

}  // namespace bodeflow::filters
