#pragma once

#include <bodeflow/block.hpp>
#include <optional>
#include <string>

#include "measured.hpp"
#include "method.hpp"

/// Parameters that the blocks of the family share.
namespace bodeflow::sanathanan_koerner {

/// inputs, outputs, band, weighting.
void describe_lines(Describe& d);
/// These and the tiers.
void describe_selection(Describe& d);
Selection read_selection(const Parameters& p);
Weighting read_weighting(const Parameters& p);

/// order, highest_order, columns, stability, iterations, tolerance, states, refine.
void describe_method(Describe& d);
void read_method(const Parameters& p, Settings& s);

/// prewarp: auto or a frequency.
void describe_prewarp(Describe& d);
std::optional<double> read_prewarp(const Parameters& p);

}  // namespace bodeflow::sanathanan_koerner
