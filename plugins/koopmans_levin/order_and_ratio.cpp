#include "order_and_ratio.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::koopmans_levin {

namespace {

constexpr double kDeviations = 2.0;  // of ln(ratio), within which an order may be found

RatioSource source_of(const Settings& s) {
  if (s.ratio) return RatioSource::declared;
  if (s.noise_band) return RatioSource::noise_band;
  return s.output_noise ? RatioSource::output_noise : RatioSource::covariance_matching;
}

/// The highest order that the lines allow, up to the one wanted.
Eigen::Index highest_possible(const Lines& lines, const Settings& s) {
  const Eigen::Index parameters_each = s.transient ? 3 : 2;
  return std::min(s.highest_order, (lines.equations() - 2) / parameters_each);
}

Expected<RatioEstimate> estimate_ratio(const Lines& lines, const Settings& s, Eigen::Index order) {
  const auto f = quick_factors(lines, order, s.transient);
  if (!f) return tl::make_unexpected(f.error());
  if (s.output_noise) return ratio_from_output_noise(lines, *f, *s.output_noise, s.output_noise_std);
  return ratio_by_covariance_matching(lines, *f, s.lags);
}

/// Fills scan and order at that ratio: the order found, or the highest one tried.
Expected<void> scan_at(const Lines& lines, const Settings& s, double ratio, OrderAndRatio& found) {
  auto scan = scan_orders(lines, ratio, highest_possible(lines, s), s.transient);
  if (!scan) return tl::make_unexpected(scan.error());
  found.order = scan->chosen > 0 ? scan->chosen : scan->orders.back().order;
  found.scan = std::move(*scan);
  return {};
}

Expected<OrderAndRatio> fall_back(const Lines& lines, const Settings& s, OrderAndRatio found) {
  if (!s.fallback_ratio) {
    return refused(found.estimate->reason +
                   "; give ratio, output_noise or noise_band, record longer, or set fallback_ratio for a model all the same");
  }
  found.ratio = *s.fallback_ratio;
  found.source = RatioSource::fallback;
  if (s.order) return found;
  if (auto done = scan_at(lines, s, found.ratio, found); !done) return tl::make_unexpected(done.error());
  return found;
}

Expected<OrderAndRatio> ratio_of_order(const Lines& lines, const Settings& s, OrderAndRatio found) {
  auto estimate = estimate_ratio(lines, s, found.order);
  if (!estimate) return tl::make_unexpected(estimate.error());
  found.estimate = std::move(*estimate);
  if (!found.estimate->determined) return fall_back(lines, s, std::move(found));
  found.ratio = found.estimate->ratio;
  return found;
}

/// Whether a scan finds `order`, or one below it, at the ratio estimated or within its uncertainty. The scan at the ratio stays.
Expected<bool> confirmed(const Lines& lines, const Settings& s, Eigen::Index order, OrderAndRatio& found) {
  const double spread = std::exp(kDeviations * found.estimate->log_ratio_std);
  bool any = false;
  for (const double factor : {1.0 / spread, spread, 1.0}) {
    if (auto done = scan_at(lines, s, found.estimate->ratio * factor, found); !done) return tl::make_unexpected(done.error());
    any = any || (found.scan->chosen > 0 && found.scan->chosen <= order);
  }
  return any;
}

/// Both sought: the lowest order that the scan at its own ratio confirms. Without one, the highest that has a ratio.
Expected<OrderAndRatio> both(const Lines& lines, const Settings& s, OrderAndRatio found) {
  std::optional<OrderAndRatio> last;
  for (Eigen::Index order = 1; order <= highest_possible(lines, s); ++order) {
    auto estimate = estimate_ratio(lines, s, order);
    if (!estimate && order > 1) break;  // data without noise leave more than one model above their order
    if (!estimate) return tl::make_unexpected(estimate.error());
    found.estimate = std::move(*estimate);
    if (!found.estimate->determined) continue;
    found.ratio = found.estimate->ratio;
    const auto right = confirmed(lines, s, order, found);
    if (!right) return tl::make_unexpected(right.error());
    found.order = order;
    found.scan->chosen = *right ? order : 0;
    if (*right) return found;
    last = found;
  }
  if (last) return *last;
  if (!found.estimate) return refused("the lines do not allow a model of order 1");
  return fall_back(lines, s, std::move(found));
}

}  // namespace

std::string name_of(RatioSource source) {
  switch (source) {
    case RatioSource::declared:
      return "declared";
    case RatioSource::covariance_matching:
      return "covariance_matching";
    case RatioSource::output_noise:
      return "output_noise";
    case RatioSource::noise_band:
      return "noise_band";
    case RatioSource::fallback:
      return "fallback";
  }
  return "";
}

Expected<OrderAndRatio> order_and_ratio(const Lines& lines, const Settings& s) {
  OrderAndRatio found;
  found.source = source_of(s);
  if (!s.ratio && !s.order) return both(lines, s, std::move(found));
  found.order = s.order.value_or(0);
  if (!s.ratio) return ratio_of_order(lines, s, std::move(found));
  found.ratio = *s.ratio;
  if (s.order) return found;
  if (auto done = scan_at(lines, s, found.ratio, found); !done) return tl::make_unexpected(done.error());
  return found;
}

}  // namespace bodeflow::koopmans_levin
