#pragma once

#include <bodeflow/error.hpp>
#include <vector>

#include "multi_band.hpp"

/// The decisions of a multi-band fit: bound, cuts, orders, pre-warp frequencies.
namespace bodeflow::sanathanan_koerner {

/// Nothing. Errors: cuts that do not rise, orders or pre-warp frequencies that are not one a band.
Expected<void> check_plan(const MultiBandSettings& settings);

/// The best fit in one band: up to the sum of the orders given, or the highest order.
Expected<Fit> one_band(const Data& data, const MultiBandSettings& settings);

/// Divisions into 2 .. most_bands bands, each the one before with its highest band cut again.
std::vector<std::vector<double>> cuts_to_try(const Data& data, Eigen::Index most_bands);

/// The bands between the cuts with their orders and pre-warp frequencies, not fitted yet.
Expected<std::vector<BandModel>> planned_bands(const Data& data, const MultiBandSettings& settings,
                                               const std::vector<double>& cuts_rad_s);

}  // namespace bodeflow::sanathanan_koerner
