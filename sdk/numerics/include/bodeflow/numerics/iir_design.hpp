#pragma once

#include <array>

#include "bodeflow/numerics/analogue_prototype.hpp"
#include "bodeflow/numerics/second_order_sections.hpp"

namespace bodeflow::numerics {

enum class Pass { low, high, band, stop };

/// A recursive filter. Edges in rad per sample, w h, between 0 and pi; low and high pass have one. What an edge is depends on the
/// family: see analogue_prototype. Band-pass and band-stop filters have 2 * order poles.
struct IirDesign {
  FilterKind kind = FilterKind::butterworth;
  Pass pass = Pass::low;
  int order = 4;
  std::array<double, 2> edges{1.0, 0.0};
  double ripple_db = 1.0;
  double attenuation_db = 60.0;
  bool impulse_invariant = false;
};

/// A filter as its roots and as sections that realise it.
struct IirFilter {
  ZeroPoleGain roots;  ///< in z, sample time 1
  Sections sections;
};

/// The filter, by one of two ways from the continuous-time prototype.
///
/// Bilinear transformation: z = (2 + s) / (2 - s) with edges pre-warped to 2 tan(w h / 2), so they lie where they were asked for;
/// the response in between is compressed towards the Nyquist frequency, and a Bessel filter loses its constant delay there.
///
/// Impulse invariance: H(z) = sum_i alpha_i z / (z - exp(s_i h)) from H(s) = sum_i h alpha_i / (s - s_i) (A. Kallen, Frequency
/// Domain Adaptive Control, 1992, section 6.2): the impulse response is h times the sampled one of the prototype, frequencies
/// are not warped, what H(s) has above the Nyquist frequency folds down. For low-pass and band-pass filters without zeros
/// (butterworth, chebyshev_1, bessel) of order up to 8 that are small, |H| < 0.1, at the Nyquist frequency. Its zeros are the
/// roots of the sum's numerator.
///
/// Errors: those of analogue_prototype; edges that are not 0 < edge < pi, or not rising; impulse invariance of another filter; a
/// design whose sections in double precision are off by more than 1e-6 of its largest gain (edges too near zero or to each other
/// for the order).
Expected<IirFilter> design_iir(const IirDesign& design);

}  // namespace bodeflow::numerics
