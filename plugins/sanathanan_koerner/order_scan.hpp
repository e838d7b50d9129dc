#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <optional>
#include <string>
#include <vector>

#include "data.hpp"
#include "method.hpp"

namespace bodeflow::sanathanan_koerner {

/// How well one order does.
struct ScannedOrder {
  Eigen::Index order = 0;
  Eigen::Index parameters = 0;  ///< real: order of the denominator, order + 1 of each numerator
  double cost = 0.0;            ///< sum of |weight (g - model)|^2
  double error = 0.0;           ///< its root over that of the data
  double aic = 0.0, mdl = 0.0;
  std::optional<double> odd_even;  ///< error on the even lines of a model of the odd ones
  std::optional<double> repeat;    ///< error of the model on a repeated measurement
};

/// Orders tried, the one proposed, and why.
struct OrderScan {
  std::vector<ScannedOrder> orders;
  std::size_t proposed = 0;
  std::string reason;
  bool still_falls = false;  ///< the proposed order is the highest tried
};

/// The order that the data support, up to settings.highest_order.
///
/// Method: with a repeated measurement the lowest order whose error on it lies within 2 % of the least; else the minimum of the
/// description length (MDL). AIC, and the error between the lines of a model of the odd ones, stand beside it as evidence: where
/// resonances are narrower than two lines the latter is no judge. A cost below rounding counts as rounding. Above 30 orders some
/// are left out. Errors: those of the method, where no order gives a model.
Expected<OrderScan> scan_orders(const Data& data, const Settings& settings, Eigen::Index inputs,
                                const std::optional<Data>& repeat);

}  // namespace bodeflow::sanathanan_koerner
