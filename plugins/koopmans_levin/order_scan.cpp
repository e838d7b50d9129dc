#include "order_scan.hpp"

#include <cmath>

namespace bodeflow::koopmans_levin {

namespace {

constexpr double kStandardDeviations = 8.0;
// Noise below this share of the greatest eigenvalue is rounding: its falls mean nothing.
constexpr double kRounding = 1e-24;

}  // namespace

Expected<OrderScan> scan_orders(const Lines& lines, double ratio, Eigen::Index highest, bool transient) {
  if (highest < 2) return refused("the scan needs a highest order of at least 2");
  OrderScan scan;
  scan.tolerance = kStandardDeviations / std::sqrt(static_cast<double>(lines.equations()));
  double least = 0.0;
  for (Eigen::Index n = 1; n <= highest; ++n) {
    const auto f = quick_factors(lines, n, transient);
    if (!f) return tl::make_unexpected(f.error());
    const auto s = solve(*f, ratio);
    if (!s && n > 1) break;  // a common factor leaves a family of models: the order before it was enough
    if (!s) return tl::make_unexpected(s.error());
    const Eigen::Index q = s->squares.size();
    least = kRounding * s->squares[0];
    scan.orders.push_back({n, s->noise_unbiased, s->squares[q - 2] / s->squares[q - 1]});
  }
  for (std::size_t i = 0; i < scan.orders.size() && scan.chosen == 0; ++i) {
    bool falls = false;
    for (std::size_t j = i + 1; j < scan.orders.size(); ++j) {
      const double here = scan.orders[i].noise, further = static_cast<double>(j - i);
      falls = falls || (here > least && here > (1.0 + scan.tolerance * std::sqrt(further)) * scan.orders[j].noise);
    }
    const bool is_last_tried = scan.orders[i].order == highest;
    if (!falls && !is_last_tried) scan.chosen = scan.orders[i].order;
  }
  return scan;
}

}  // namespace bodeflow::koopmans_levin
