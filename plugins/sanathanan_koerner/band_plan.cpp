#include "band_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "measured.hpp"
#include "monomial.hpp"

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr Eigen::Index kLeastLines = 10;  // of a band that is cut off
constexpr Eigen::Index kWindows = 40;     // the slope is a mean over 1/40 of the range to either side
constexpr double kLeastWay = 0.05;        // of the response's way from line to line that lies on either side of a cut
constexpr Eigen::Index kOrderSteps = 6;   // orders tried for a band
constexpr double kWorthwhile = 0.9;       // a higher order must bring the error below this share to be taken
constexpr int kScanIterations = 5;

Expected<Fit> best_prewarp(const Data& data, Eigen::Index order, double low, double high, const MultiBandSettings& s,
                           int iterations) {
  FitSettings settings{order, s.weight_exponent, true, {}};
  settings.stop.iterations = iterations;
  Eigen::VectorXd ends(2);
  ends << low, high;
  Expected<Fit> best = unexpected("no pre-warp frequency");
  for (const double a : prewarp_candidates(ends, 5)) {
    auto one = s.monomial ? monomial_fit(data, Plane{a, 0.0}, settings) : fit(data, Plane{a, 0.0}, settings);
    if (!best || (one && one->error() < best->error())) best = std::move(one);
  }
  return best;
}

/// The lines of the band alone, as wanted from it: the tiers weigh what lies outside.
Data band_data(const Data& data, double low, double high, const MultiBandSettings& s) {
  const Eigen::VectorXd tiers = tiered_weights(data.omega_rad_s, {low, high, s.below, s.above});
  return {data.omega_rad_s, data.response, tiers.asDiagonal() * data.weights};
}

/// The lowest order beyond which the error of the band falls little.
Expected<Fit> order_and_prewarp(const Data& data, double low, double high, const MultiBandSettings& s) {
  Expected<Fit> best = unexpected("no order");
  for (Eigen::Index n = 1; n <= kOrderSteps; ++n) {
    const Eigen::Index order = std::max<Eigen::Index>(1, n * s.highest_order / kOrderSteps);
    if (best && order == best->model.order()) continue;
    auto one = best_prewarp(data, order, low, high, s, kScanIterations);
    if (!best || (one && one->error() < kWorthwhile * best->error())) best = std::move(one);
  }
  return best;
}

}  // namespace

Expected<void> check_plan(const MultiBandSettings& s) {
  if (!std::is_sorted(s.cuts_rad_s.begin(), s.cuts_rad_s.end(), [](double a, double b) { return a <= b; }))
    return unexpected("the cuts between the bands must rise");
  const auto bands = s.cuts_rad_s.size() + 1;
  const auto fits = [&](std::size_t count, const char* what) -> Expected<void> {
    if (count == 0) return {};
    if (s.cuts_rad_s.empty()) return unexpected(std::string(what) + " are given band by band: give the cuts too");
    if (count == bands) return {};
    return unexpected(std::to_string(count) + " " + what + " for " + std::to_string(bands) + " bands");
  };
  if (auto good = fits(s.orders.size(), "orders"); !good) return good;
  return fits(s.prewarps_rad_s.size(), "pre-warp frequencies");
}

Expected<Fit> one_band(const Data& data, const MultiBandSettings& s) {
  const Eigen::Index highest =
      s.orders.empty() ? s.highest_order : std::accumulate(s.orders.begin(), s.orders.end(), Eigen::Index{0});
  const double low = data.omega_rad_s[0] > 0.0 || data.lines() < 2 ? data.omega_rad_s[0] : data.omega_rad_s[1];
  Expected<Fit> best = unexpected("no order");
  for (const Eigen::Index order : {highest, (3 * highest) / 4, highest / 2}) {
    if (order < 1) continue;
    auto one = best_prewarp(data, order, low, data.omega_rad_s[data.lines() - 1], s, kScanIterations);
    if (!best || (one && one->error() < best->error())) best = std::move(one);
  }
  return best;
}

std::optional<Eigen::Index> flattest_line(const Data& data, Eigen::Index first, Eigen::Index last) {
  const Eigen::Index count = last - first + 1, reach = std::max<Eigen::Index>(2, count / kWindows);
  if (count < 2 * kLeastLines + 2 * reach) return {};
  const Eigen::VectorXd size = data.response.rowwise().norm().array().max(1e-300).log();
  const auto slope = [&](Eigen::Index k) {
    return std::abs((size[k + 1] - size[k]) / std::log(data.omega_rad_s[k + 1] / std::max(data.omega_rad_s[k], 1e-300)));
  };
  // A flat end of the range holds no modes: a band there would have nothing to fit.
  const Eigen::VectorXd way =
      (data.response.middleRows(first + 1, count - 1) - data.response.middleRows(first, count - 1)).rowwise().norm();
  const double all = way.sum();
  double gone = way.head(std::max(kLeastLines, reach + 1) - 1).sum();
  Eigen::Index flattest = 0;
  double least = INFINITY;
  const Eigen::Index from = first + std::max(kLeastLines, reach + 1), to = first + count / 2;
  for (Eigen::Index k = from; k <= std::min(to, last - kLeastLines - reach); ++k) {
    gone += way[k - first - 1];
    if (gone < kLeastWay * all || gone > (1.0 - kLeastWay) * all) continue;
    double mean = 0.0;
    for (Eigen::Index n = k - reach; n < k + reach; ++n) mean += slope(n);
    if (mean >= least) continue;
    least = mean;
    flattest = k;
  }
  return std::isfinite(least) ? std::optional(flattest) : std::nullopt;
}

std::vector<std::vector<double>> cuts_to_try(const Data& data, Eigen::Index most_bands) {
  std::vector<std::vector<double>> divisions;
  std::vector<double> cuts;
  Eigen::Index first = 0;
  while (static_cast<Eigen::Index>(cuts.size()) + 1 < most_bands) {
    const auto line = flattest_line(data, first, data.lines() - 1);
    if (!line) break;
    cuts.push_back(data.omega_rad_s[*line]);
    divisions.push_back(cuts);
    first = *line + 1;
  }
  return divisions;
}

Expected<std::vector<BandModel>> planned_bands(const Data& data, const MultiBandSettings& s, const std::vector<double>& cuts) {
  std::vector<BandModel> bands;
  const double last = data.omega_rad_s[data.lines() - 1];
  for (std::size_t b = 0; b <= cuts.size(); ++b) {
    BandModel band;
    band.low_rad_s = b == 0 ? data.omega_rad_s[0] : cuts[b - 1];
    band.high_rad_s = b == cuts.size() ? last : cuts[b];
    const double positive = band.low_rad_s > 0.0 || data.lines() < 2 ? band.low_rad_s : data.omega_rad_s[1];
    const Data part = band_data(data, band.low_rad_s, band.high_rad_s, s);
    const std::string name = "band " + std::to_string(b + 1) + ": ";
    if (!s.orders.empty()) band.order = s.orders[b];
    if (!s.prewarps_rad_s.empty()) band.prewarp_rad_s = s.prewarps_rad_s[b];
    if (s.orders.empty()) {
      const auto found = order_and_prewarp(part, positive, band.high_rad_s, s);
      if (!found) return unexpected(name + found.error().text);
      band.order = found->model.order();
      if (s.prewarps_rad_s.empty()) band.prewarp_rad_s = found->model.plane.prewarp_rad_s;
    } else if (s.prewarps_rad_s.empty()) {
      const auto found = best_prewarp(part, band.order, positive, band.high_rad_s, s, kScanIterations);
      if (!found) return unexpected(name + found.error().text);
      band.prewarp_rad_s = found->model.plane.prewarp_rad_s;
    }
    bands.push_back(std::move(band));
  }
  return bands;
}

}  // namespace bodeflow::sanathanan_koerner
