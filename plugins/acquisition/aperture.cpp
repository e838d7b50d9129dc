#include "aperture.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::acquisition {

ApertureSampler::ApertureSampler(std::size_t factor, std::size_t max_outputs)
    : factor_(factor), frame_(factor * (max_outputs + 1)) {}

void ApertureSampler::reset() { std::fill(frame_.begin(), frame_.end(), 0.0); }

void ApertureSampler::run(std::span<const double> x, std::span<const double> displacement, std::span<double> y) {
  if (displacement.empty()) {
    for (std::size_t m = 0; m < y.size(); ++m) y[m] = x[m * factor_];
    return;
  }
  std::copy(x.begin(), x.end(), frame_.begin() + static_cast<std::ptrdiff_t>(factor_));
  for (std::size_t m = 0; m < y.size(); ++m) {
    const double whole = std::floor(displacement[m]), t = displacement[m] - whole;
    const double* const p = frame_.data() + (m + 1) * factor_ + static_cast<std::ptrdiff_t>(whole);
    y[m] = -t * (t - 1) * (t - 2) / 6 * p[-1] + (t + 1) * (t - 1) * (t - 2) / 2 * p[0] - (t + 1) * t * (t - 2) / 2 * p[1] +
           (t + 1) * t * (t - 1) / 6 * p[2];
  }
  std::copy_n(frame_.begin() + static_cast<std::ptrdiff_t>(x.size()), factor_, frame_.begin());
}

}  // namespace bodeflow::acquisition
