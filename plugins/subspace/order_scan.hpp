#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model.hpp"
#include "quality.hpp"

namespace bodeflow::subspace {

/// What speaks for an order.
struct ScannedOrder {
  Eigen::Index order = 0;
  double singular_value = 0.0;  ///< of that number, of the whole data
  Quality validation;           ///< on lines that were not fitted
  Eigen::Index unstable = 0;    ///< poles outside the unit disc before a projection
};

struct OrderScan {
  std::vector<ScannedOrder> orders;
  Eigen::Index chosen = 1;
  std::string rule;  ///< why that one
};

struct ScanSettings {
  Eigen::Index functions = 40;  ///< fewer where half the lines allow no more
  Basis basis = Basis::arnoldi;
  Stability stability = Stability::project;
  Eigen::Index highest_order = 40;
};

/// A gap between singular values that decides the order by itself.
inline constexpr double kClearGap = 100.0;
/// Errors up to that much above the least one count as equal to it.
inline constexpr double kAsGood = 1.1;

/// The order, with its evidence: where one singular value is kClearGap times the next one, the order up to there; else the least
/// order whose weighted error on lines that were not fitted is within kAsGood of the best. Those lines are every second one, or
/// those of `repeated`, another measurement of the same system: with few lines on a resonance only that one is fair to high
/// orders. Singular values show no gap once noise covers the weakest modes. For long data at most 2000 lines are fitted and
/// validated per order. Errors: those of range_of; no order that gives a model.
Expected<OrderScan> scan_orders(const Lines& lines, const Plane& plane, const ScanSettings& settings,
                                const std::optional<Lines>& repeated = {});

}  // namespace bodeflow::subspace
