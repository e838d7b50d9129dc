#include "order_scan.hpp"

#include <algorithm>
#include <bodeflow/numerics/chi_squared.hpp>
#include <cmath>

namespace bodeflow::maximum_likelihood {

namespace {

constexpr double kSignificant = 0.01;
constexpr double kRounding = 1e-20;  // of the power of the data, in units of their variance

double chance_of_fall(const Spectra& spectra, const Fit& from, const Fit& to, double rounding) {
  const double before = std::max(from.minimum.cost, rounding), after = std::max(to.minimum.cost, rounding);
  const double equations = spectra.equations(), nu = spectra.degrees_of_freedom;
  const double part = std::isinf(nu) || !(nu > 2.0) ? 1.0 : (nu - 2.0) / nu;
  const double fall = spectra.variance_known ? 2.0 * part * (before - after) : 2.0 * equations * std::log(before / after);
  const auto added = static_cast<double>(to.parameters() - from.parameters());
  if (!(fall > 0.0) || !(added > 0.0)) return 1.0;
  return std::min(1.0, equations * numerics::chi_squared_tail(fall, added));
}

}  // namespace

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
  const double rounding = kRounding * spectra.power();
  for (std::size_t i = 0; i < scan.orders.size(); ++i) {
    for (std::size_t j = i + 1; j < scan.orders.size(); ++j) {
      scan.orders[i].significance =
          std::min(scan.orders[i].significance, chance_of_fall(spectra, scan.orders[i].fit, scan.orders[j].fit, rounding));
    }
  }
  while (scan.chosen + 1 < scan.orders.size() && scan.orders[scan.chosen].significance < kSignificant) ++scan.chosen;
  scan.still_falls = scan.chosen > 0 && scan.chosen + 1 == scan.orders.size();
  return scan;
}

}  // namespace bodeflow::maximum_likelihood
