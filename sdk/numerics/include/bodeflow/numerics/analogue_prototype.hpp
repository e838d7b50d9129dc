#pragma once

#include "bodeflow/numerics/linear_system.hpp"

namespace bodeflow::numerics {

enum class FilterKind { butterworth, chebyshev_1, chebyshev_2, bessel, elliptic };

/// The highest order of a prototype.
inline constexpr int kMostFilterOrder = 16;

/// The continuous-time low-pass filter of a family with its edge at 1 rad/s, of largest gain 1:
/// butterworth, bessel: |H(j)| = 1 / sqrt 2; chebyshev_1, elliptic: ripple_db below 1 up to the edge; chebyshev_2: attenuation_db
/// from the edge on; elliptic: attenuation_db from the least frequency on that the order allows.
///
/// Method: poles and zeros in closed form; Bessel's as the roots of theta_n, polished by Newton steps; the elliptic ones by
/// Jacobi's functions, the modulus from the nome (q = q_1^(1/n) solves the degree equation). Source: T. W. Parks, C. S. Burrus,
/// Digital Filter Design, 1987, chapter 7. Errors: an order outside 1 .. kMostFilterOrder, a ripple outside 0.0001 .. 20 dB, an
/// attenuation outside 5 .. 200 dB or not above the ripple.
Expected<ZeroPoleGain> analogue_prototype(FilterKind kind, int order, double ripple_db = 1.0, double attenuation_db = 60.0);

/// The Bessel filter whose poles have the product 1, as the roots of theta_n(s theta_n(0)^(1/n)): for low frequencies its delay
/// is that of a Bessel filter with its edge at 1 rad/s in the sense of phase, whatever the order.
Expected<ZeroPoleGain> bessel_of_unit_product(int order);

}  // namespace bodeflow::numerics
