#include "sine_window.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bodeflow::spectrum {

SineTable::SineTable(std::int64_t window, std::int64_t cycles) : values_(static_cast<std::size_t>(window)) {
  const double scale = 2.0 / static_cast<double>(window);
  for (std::int64_t n = 0, turned = 0; n < window; ++n) {
    const std::int64_t nearest = 2 * turned > window ? turned - window : turned;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(nearest) / static_cast<double>(window);
    values_[static_cast<std::size_t>(n)] = {scale * std::cos(angle), -scale * std::sin(angle)};
    turned = (turned + cycles) % window;
  }
}

void SineWindow::clear() {
  std::fill(terms_.begin(), terms_.end(), 0.0);
  at_ = 0;
  running_ = fresh_ = 0.0;
}

}  // namespace bodeflow::spectrum
