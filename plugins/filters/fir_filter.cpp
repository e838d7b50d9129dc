#include "fir_filter.hpp"

#include <algorithm>

#include "kernels.hpp"

namespace bodeflow::filters {

FirFilter::FirFilter(std::span<const double> h, std::size_t max_count)
    : h_(h.begin(), h.end()), frame_(h.size() - 1 + max_count) {}

void FirFilter::run(std::span<const double> x, std::span<double> y, int vector_level) {
  const std::size_t past = h_.size() - 1;
  std::copy(x.begin(), x.end(), frame_.begin() + static_cast<std::ptrdiff_t>(past));
  run_fir(h_.data(), h_.size(), frame_.data() + past, y.data(), y.size(), vector_level);
  std::copy_n(frame_.begin() + static_cast<std::ptrdiff_t>(x.size()), past, frame_.begin());
}

void FirFilter::reset() { std::fill(frame_.begin(), frame_.end(), 0.0); }

}  // namespace bodeflow::filters
