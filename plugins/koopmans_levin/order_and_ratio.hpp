#pragma once

#include "identification.hpp"

namespace bodeflow::koopmans_levin {

/// Order and ratio that a model is made with, and how they were found: the members of Identification of the same names.
struct OrderAndRatio {
  Eigen::Index order = 0;
  double ratio = 1.0;
  RatioSource source = RatioSource::declared;
  std::optional<RatioEstimate> estimate;
  std::optional<OrderScan> scan;
};

/// What the settings say, or what the lines tell. Where neither is given: the lowest order at whose own ratio, or within two
/// standard deviations of it, a scan finds no need for more; from above it would not do, since a model of too high an order fits
/// with any common factor in A and B, and tells no ratio. The output noise of a noise band stands in the settings as
/// output_noise. Errors: those of the scan and of the estimates; not determined, without a fallback.
Expected<OrderAndRatio> order_and_ratio(const Lines& lines, const Settings& settings);

}  // namespace bodeflow::koopmans_levin
