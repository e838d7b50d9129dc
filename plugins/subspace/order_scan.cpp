#include "order_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "records/signals.hpp"

namespace bodeflow::subspace {
namespace {

constexpr Eigen::Index kMostLines = 2000;  // that are fitted and validated per order

/// At most so many of the lines, evenly.
Lines thinned(const Lines& lines) {
  if (lines.size() <= kMostLines) return lines;
  Eigen::VectorXi rows(kMostLines);
  for (Eigen::Index k = 0; k < kMostLines; ++k) rows[k] = static_cast<int>(k * (lines.size() - 1) / (kMostLines - 1));
  return {lines.omega_rad_s(rows), lines.response(rows, Eigen::all), lines.outputs, lines.weight(rows)};
}

void choose_by_validation(OrderScan& scan, bool repeated) {
  double best = std::numeric_limits<double>::infinity();
  for (const ScannedOrder& one : scan.orders) best = std::min(best, one.validation.weighted);
  const auto found = std::find_if(scan.orders.begin(), scan.orders.end(),
                                  [&](const ScannedOrder& one) { return one.validation.weighted <= kAsGood * best; });
  scan.chosen = found->order;
  scan.rule = "the lowest order within 10 % of the least error on ";
  scan.rule += repeated ? "the repeated measurement" : "the lines that were not fitted (every second one)";
}

/// The order before the widest gap; 0: none is clear.
Eigen::Index clear_gap(const Eigen::VectorXd& s, Eigen::Index highest, double& widest) {
  Eigen::Index order = 0;
  const double floor = std::numeric_limits<double>::epsilon() * s[0];
  widest = kClearGap;
  for (Eigen::Index n = 1; n <= highest && n < s.size() && s[n - 1] > floor; ++n) {
    const double gap = s[n - 1] / std::max(s[n], floor);
    if (gap <= widest) continue;
    widest = gap;
    order = n;
  }
  return order;
}

}  // namespace

Expected<OrderScan> scan_orders(const Lines& lines, const Plane& plane, const ScanSettings& settings,
                                const std::optional<Lines>& repeated) {
  if (!repeated && lines.size() < 4) return unexpected(std::to_string(lines.size()) + " lines are too few to find an order");
  const auto whole = range_of(lines, plane, settings.functions, settings.basis);
  if (!whole) return unexpected(whole.error().text);
  const Lines fitted = repeated ? lines : every_second(lines, 0), held = repeated ? *repeated : every_second(lines, 1);
  const Eigen::Index functions = std::min(settings.functions, most_functions(fitted));
  const auto range = repeated ? whole : range_of(fitted, plane, functions, settings.basis);
  if (!range) return unexpected(range.error().text);
  const Lines few = thinned(fitted), judges = thinned(held);
  const Eigen::Index most =
      std::min({settings.highest_order, range->vectors.rows() - lines.outputs, range->singular_values.size() - 1});
  OrderScan scan;
  for (Eigen::Index order = 1; order <= most; ++order) {
    const auto model = model_of_order(few, plane, *range, order, settings.stability);
    if (!model) continue;
    const Quality quality = quality_of(judges, response_of(model->system, judges.omega_rad_s));
    if (!std::isfinite(quality.weighted)) continue;
    scan.orders.push_back({order, whole->singular_values[order - 1], quality, model->moved + model->unstable});
  }
  if (scan.orders.empty()) return unexpected("no order up to " + std::to_string(settings.highest_order) + " gives a model");
  double gap = 0.0;
  const Eigen::Index by_gap = clear_gap(whole->singular_values, most, gap);
  if (by_gap == 0) {
    choose_by_validation(scan, repeated.has_value());
    return scan;
  }
  scan.chosen = by_gap;
  scan.rule = "singular value " + std::to_string(by_gap) + " is " + records::short_number(gap, 2) + " times the next one";
  return scan;
}

}  // namespace bodeflow::subspace
