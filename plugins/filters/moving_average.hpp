#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace bodeflow::filters {

/// The mean of the last `length` samples of one channel, in two additions a sample whatever the length.
///
/// Method: the stream is cut into blocks of `length`, counted from its start; a window is the end of one block and the beginning
/// of the next, sum = (suffix sum of the one) + (prefix sum of the other). Nothing is ever subtracted, so rounding does not add
/// up and a value that is not finite is forgotten. At the end of a block its suffix sums cost `length` additions at once.
class MovingAverage {
 public:
  explicit MovingAverage(std::size_t length);

  /// x.size() == y.size(); y may be x.
  void run(std::span<const double> x, std::span<double> y);

  /// Back to a past of zeros.
  void reset();

 private:
  std::vector<double> block_;   // the samples of this block so far
  std::vector<double> suffix_;  // of the block before: suffix_[i] = sum from i on
  double prefix_ = 0.0;         // sum of this block so far
  std::size_t filled_ = 0;
};

}  // namespace bodeflow::filters
