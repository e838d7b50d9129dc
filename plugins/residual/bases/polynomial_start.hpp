#pragma once

#include <bodeflow/plant.hpp>
#include <complex>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace bodeflow::residual {

/// Real coefficients d of D(s) = d0 + d1 s + ... + dn s^n near which N(s) / D(s) follows the measured responses, at frequencies
/// above 0; nothing where they do not determine it.
///
/// Method: linear least squares of w (G D - N) / D', reweighted with the denominator D' of the round before; the first round
/// takes N / G for it. Noise of G biases the first rounds, not the last. n <= 3.
/// Reference: C. K. Sanathanan, J. Koerner, Transfer function synthesis as a ratio of two complex polynomials, IEEE Trans.
/// Automatic Control 8 (1963) 56, doi:10.1109/TAC.1963.1105517.
std::optional<std::vector<double>> denominator_near(std::span<const MeasuredResponse> measured,
                                                    const std::function<std::complex<double>(std::complex<double>)>& numerator,
                                                    int degree);

/// The lines of all responses at frequencies above 0 with a response and a weight above 0, joined and in order of frequency.
MeasuredResponse joined_lines(std::span<const MeasuredResponse> measured);

}  // namespace bodeflow::residual
