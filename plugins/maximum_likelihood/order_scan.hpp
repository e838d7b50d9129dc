#pragma once

#include <functional>
#include <vector>

#include "diagnosis.hpp"

namespace bodeflow::maximum_likelihood {

/// One order of a scan.
struct ScannedOrder {
  Fit fit;
  CostTest test;
  Criteria criteria;
  double significance = 1.0;  ///< smallest chance, over the higher orders, of a fall of the cost as large as theirs
};

struct OrderScan {
  std::vector<ScannedOrder> orders;  ///< rising
  std::size_t chosen = 0;            ///< index
  bool still_falls = false;          ///< the cost falls significantly up to the highest order tried
};

/// The chance that the cost falls as far from one fit to a larger one where the smaller is enough; see scan_orders.
double chance_of_fall(const Spectra& spectra, const Fit& from, const Fit& to);

/// The chance of a fall below which the larger model counts: 1 %.
inline constexpr double kSignificantFall = 0.01;

/// The lowest order whose cost no higher one undercuts significantly.
///
/// From order n to m, 2 (V_n - V_m) (nu - 2)/nu is chi-squared with as many degrees of freedom as there are new parameters, where
/// n is enough; with correlated lines the fall is divided by the `inflation` of m; without known variance 2F ln(V_n / V_m). The
/// pole and zero that a higher order adds may go to any of the F lines, so the chance is multiplied by F; below 1 % (in all) the
/// higher order counts. AIC and MDL stand beside: AIC takes too high an order in one of six cases and more, MDL at few lines.
/// Costs that differ by rounding alone (1e-20 of the power of the data) are alike. structure_of: the structure for an order.
/// Errors: those of fit_model at the lowest order; the scan ends where a higher order has too many parameters for the lines.
Expected<OrderScan> scan_orders(const Spectra& spectra, const std::function<Structure(Eigen::Index)>& structure_of,
                                Eigen::Index lowest, Eigen::Index highest, int starts);

}  // namespace bodeflow::maximum_likelihood
