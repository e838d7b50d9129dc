#include "decimator.hpp"

#include <algorithm>
#include <bodeflow/numerics/fir.hpp>

namespace bodeflow::filters {
namespace {

// Kaiser's formula for the length is good to about 1 dB.
constexpr double kMarginDb = 2.0;

}  // namespace

Decimator::Decimator(std::span<const double> taps, std::size_t factor, std::size_t max_outputs)
    : taps_(taps.begin(), taps.end()), factor_(factor), frame_(taps.size() - 1 + max_outputs * factor) {}

void Decimator::run(std::span<const double> x, std::span<double> y) {
  const std::size_t past = taps_.size() - 1;
  std::copy(x.begin(), x.end(), frame_.begin() + static_cast<std::ptrdiff_t>(past));
  // The taps are symmetric: forward in time is as good as backward.
  for (std::size_t m = 0; m < y.size(); ++m) y[m] = numerics::dot(frame_.data() + m * factor_, taps_.data(), taps_.size());
  std::copy_n(frame_.begin() + static_cast<std::ptrdiff_t>(x.size()), past, frame_.begin());
}

void Decimator::reset() { std::fill(frame_.begin(), frame_.end(), 0.0); }

numerics::Expected<std::vector<double>> anti_alias_taps(std::size_t factor, double pass_band, double attenuation_db) {
  const double nyquist = 1.0 / static_cast<double>(factor);
  const numerics::LowPass design{pass_band * nyquist, nyquist, attenuation_db + kMarginDb};
  const auto half = numerics::low_pass_half_length(design);
  if (!half) return tl::make_unexpected(half.error());
  const auto step = static_cast<Eigen::Index>(factor);
  const Eigen::VectorXd taps = numerics::low_pass(design, (*half + step - 1) / step * step);
  return std::vector<double>(taps.begin(), taps.end());
}

}  // namespace bodeflow::filters
