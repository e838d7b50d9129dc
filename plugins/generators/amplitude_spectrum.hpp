#pragma once

#include <bodeflow/numerics/error.hpp>
#include <span>
#include <vector>

namespace bodeflow::generators {

/// The amplitude at each frequency [Hz, rising] from a curve given by points: straight lines in a doubly logarithmic plot.
/// Errors: lists of different or no length, points that are not rising or not positive, a frequency outside of the curve.
numerics::Expected<std::vector<double>> amplitudes_on_curve(std::span<const double> point_frequencies,
                                                            std::span<const double> point_amplitudes,
                                                            std::span<const double> frequencies);

}  // namespace bodeflow::generators
