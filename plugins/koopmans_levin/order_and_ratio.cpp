#include "order_and_ratio.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::koopmans_levin {

namespace {

constexpr int kMostRounds = 5;

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
  found.order = s.order.value_or(0);
  found.ratio = s.ratio.value_or(lines.weight.dot(lines.output.cwiseAbs2()) / lines.weight.dot(lines.input.cwiseAbs2()));
  Eigen::Index before = -1;
  for (int round = 0; round < kMostRounds; ++round) {
    if (!s.order) {
      if (auto done = scan_at(lines, s, found.ratio, found); !done) return tl::make_unexpected(done.error());
    }
    if (s.ratio || found.order == before) return found;
    auto estimate = estimate_ratio(lines, s, found.order);
    if (!estimate) return tl::make_unexpected(estimate.error());
    found.estimate = std::move(*estimate);
    if (!found.estimate->determined) return fall_back(lines, s, std::move(found));
    found.ratio = found.estimate->ratio;
    if (s.order) return found;
    before = found.order;
  }
  found.settled = false;
  found.order = before;
  return found;
}

}  // namespace bodeflow::koopmans_levin
