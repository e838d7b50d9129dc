#include "moving_average.hpp"

#include <algorithm>

namespace bodeflow::filters {

MovingAverage::MovingAverage(std::size_t length) : block_(length), suffix_(length + 1) {}

void MovingAverage::run(std::span<const double> x, std::span<double> y) {
  const std::size_t length = block_.size();
  const auto count = static_cast<double>(length);
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double value = x[n];
    block_[filled_] = value;
    prefix_ = filled_ == 0 ? value : prefix_ + value;
    ++filled_;
    y[n] = (suffix_[filled_] + prefix_) / count;
    if (filled_ < length) continue;
    for (std::size_t i = length; i > 0; --i) suffix_[i - 1] = suffix_[i] + block_[i - 1];
    filled_ = 0;
  }
}

void MovingAverage::reset() {
  std::fill(suffix_.begin(), suffix_.end(), 0.0);
  prefix_ = 0;
  filled_ = 0;
}

}  // namespace bodeflow::filters
