#include "order_scan.hpp"

#include <algorithm>
#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::sanathanan_koerner {
namespace {

constexpr Eigen::Index kMostOrders = 30;
constexpr double kRounding = 1e-12;  // error below which an order reproduces the data
constexpr double kAlike = 1.02;      // errors on a repeated measurement that close count as equal

std::vector<Eigen::Index> orders_to_try(Eigen::Index highest) {
  std::vector<Eigen::Index> orders;
  const Eigen::Index step = (highest + kMostOrders - 1) / kMostOrders;
  for (Eigen::Index n = step; n <= highest; n += step) orders.push_back(n);
  if (orders.empty() || orders.back() != highest) orders.push_back(highest);
  return orders;
}

/// Error of a fitted system on other lines, in their weights.
double error_on(const Data& data, const numerics::StateSpace& system) {
  const auto at = numerics::frequency_response(system, data.omega_rad_s / (2.0 * std::numbers::pi));
  Eigen::MatrixXcd model(data.lines(), data.channels());
  for (Eigen::Index k = 0; k < data.lines(); ++k) model.row(k) = at[static_cast<std::size_t>(k)].transpose();
  return weighted_residual(data, model).norm() / weighted_norm(data);
}

std::optional<double> odd_even_error(const Data& data, const Settings& settings, Eigen::Index order, Eigen::Index inputs) {
  std::vector<Eigen::Index> odd, even;
  for (Eigen::Index k = 0; k < data.lines(); ++k) (k % 2 == 0 ? odd : even).push_back(k);
  if (even.empty()) return {};
  const Data others = lines_of(data, even);
  if (!check(others)) return {};
  const auto part = fitted(lines_of(data, odd), settings, order, inputs);
  if (!part) return {};
  const double error = error_on(others, part->system);
  return std::isfinite(error) ? std::optional(error) : std::nullopt;
}

void judge(ScannedOrder& one, const Data& data, const Settings& settings) {
  Eigen::Index equations = 0;
  for (Eigen::Index i = 0; i < data.channels(); ++i) equations += (data.weights_of(i).array() > 0.0).count();
  const double F = static_cast<double>(equations), n = static_cast<double>(one.parameters);
  const double floor = std::pow(kRounding * weighted_norm(data), 2);
  const double likelihood = settings.known_variance ? 2.0 * one.cost : 2.0 * F * std::log(std::max(one.cost, floor) / F);
  one.aic = likelihood + 2.0 * n;
  one.mdl = likelihood + n * std::log(2.0 * F);
}

void propose(OrderScan& scan, bool repeated) {
  const auto& all = scan.orders;
  const auto least = [&](auto value) {
    return static_cast<std::size_t>(
        std::min_element(all.begin(), all.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); }) -
        all.begin());
  };
  const auto far = [](const std::optional<double>& error) { return error.value_or(INFINITY); };
  const std::size_t by_mdl = least([](const auto&o) { return o.mdl; }), by_aic = least([](const auto&o) { return o.aic; });
  const std::size_t by_lines = least([&](const auto& o) { return far(o.odd_even); });
  scan.proposed = by_mdl;
  if (repeated) {
    const double limit = kAlike * far(all[least([&](const auto& o) { return far(o.repeat); })].repeat);
    scan.proposed = 0;
    while (!(far(all[scan.proposed].repeat) <= limit)) ++scan.proposed;
    scan.reason = "the lowest order whose error on the repeated measurement is within 2 % of the least; MDL has its minimum at " +
                  std::to_string(all[by_mdl].order);
  } else {
    scan.reason = "the minimum of MDL";
  }
  scan.reason += ", AIC at " + std::to_string(all[by_aic].order);
  if (all[by_lines].odd_even) scan.reason += ", the error between the fitted lines at " + std::to_string(all[by_lines].order);
  scan.still_falls = all.size() > 1 && scan.proposed + 1 == all.size();
}

}  // namespace

Expected<OrderScan> scan_orders(const Data& data, const Settings& settings, Eigen::Index inputs,
                                const std::optional<Data>& repeat) {
  Settings brief = settings;
  brief.refine = false;
  OrderScan scan;
  std::string why;
  for (const Eigen::Index order : orders_to_try(settings.highest_order)) {
    const auto one = fitted(data, brief, order, inputs);
    if (!one) {
      why = one.error().text;
      continue;
    }
    ScannedOrder s{order,
                   order + data.channels() * (order + 1),
                   weighted_residual(data, one->response).squaredNorm(),
                   one->error(),
                   0.0,
                   0.0,
                   odd_even_error(data, brief, order, inputs),
                   {}};
    if (repeat) s.repeat = error_on(*repeat, one->system);
    judge(s, data, settings);
    scan.orders.push_back(s);
  }
  if (scan.orders.empty()) return unexpected(why);
  propose(scan, repeat.has_value());
  return scan;
}

}  // namespace bodeflow::sanathanan_koerner
