#include "order_scan.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr double kRounding = 1e-20;  // of the power of the data, in units of their variance

}  // namespace

double chance_of_fall(const Spectra& spectra, const Fit& from, const Fit& to) {
  const double rounding = kRounding * spectra.power();
  const double before = std::max(from.minimum.cost, rounding), after = std::max(to.minimum.cost, rounding);
  const double equations = spectra.equations(), nu = spectra.degrees_of_freedom;
  const double part = std::isinf(nu) || !(nu > 2.0) ? 1.0 : (nu - 2.0) / nu;
  const double raw = spectra.variance_known ? 2.0 * part * (before - after) : 2.0 * equations * std::log(before / after);
  // A delay at the end of its range is no parameter, and yet the larger model has its coefficients.
  const auto added = static_cast<double>(std::max<Eigen::Index>(1, to.parameters() - from.parameters()));
  const double fall = raw / to.inflation;
  if (!(fall > 0.0)) return 1.0;
  return std::min(1.0, equations * numerics::chi_squared_tail(fall, added));
}

Expected<OrderScan> scan_orders(const Spectra& spectra, const std::function<Structure(Eigen::Index)>& structure_of,
                                Eigen::Index lowest, Eigen::Index highest, int starts) {
  OrderScan scan;
  for (Eigen::Index n = lowest; n <= highest; ++n) {
    const Fit* lower = scan.orders.empty() ? nullptr : &scan.orders.back().fit;
    auto fit = fit_model(spectra, structure_of(n), starts, lower);
    if (!fit && !scan.orders.empty()) break;
    if (!fit) return refusal_in(fit);
    ScannedOrder order{std::move(*fit), {}, {}, 1.0};
    order.test = cost_test(spectra, order.fit);
    order.criteria = criteria(spectra, order.fit);
    scan.orders.push_back(std::move(order));
  }
  for (std::size_t i = 0; i < scan.orders.size(); ++i) {
    for (std::size_t j = i + 1; j < scan.orders.size(); ++j) {
      scan.orders[i].significance =
          std::min(scan.orders[i].significance, chance_of_fall(spectra, scan.orders[i].fit, scan.orders[j].fit));
    }
  }
  while (scan.chosen + 1 < scan.orders.size() && scan.orders[scan.chosen].significance < kSignificantFall) ++scan.chosen;
  scan.still_falls = scan.chosen > 0 && scan.chosen + 1 == scan.orders.size();
  return scan;
}

}  // namespace bodeflow::maximum_likelihood
