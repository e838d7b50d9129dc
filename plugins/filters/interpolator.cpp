#include "interpolator.hpp"

#include <algorithm>
#include <bodeflow/numerics/fir.hpp>

namespace bodeflow::filters {

Interpolator::Interpolator(std::span<const double> h, std::size_t factor, std::size_t max_inputs)
    : factor_(factor), taps_((h.size() + factor - 1) / factor), phases_(taps_ * factor), frame_(taps_ - 1 + max_inputs) {
  for (std::size_t i = 0; i < h.size(); ++i) phases_[(i % factor) * taps_ + (taps_ - 1 - i / factor)] = h[i];
}

void Interpolator::run(std::span<const double> x, std::span<double> y) {
  const std::size_t past = taps_ - 1;
  std::copy(x.begin(), x.end(), frame_.begin() + static_cast<std::ptrdiff_t>(past));
  for (std::size_t m = 0; m < x.size(); ++m) {
    for (std::size_t p = 0; p < factor_; ++p) {
      y[m * factor_ + p] = numerics::dot(frame_.data() + m, phases_.data() + p * taps_, taps_);
    }
  }
  std::copy_n(frame_.begin() + static_cast<std::ptrdiff_t>(x.size()), past, frame_.begin());
}

void Interpolator::reset() { std::fill(frame_.begin(), frame_.end(), 0.0); }

}  // namespace bodeflow::filters
