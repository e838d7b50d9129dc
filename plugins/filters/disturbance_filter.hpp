#pragma once

#include <bodeflow/numerics/error.hpp>
#include <bodeflow/numerics/second_order_sections.hpp>
#include <vector>

namespace bodeflow::filters {

/// What a disturbance filter takes out, all angles in rad per sample (w h).
struct DisturbanceDesign {
  int steps = 1;                  ///< zeros at z = 1: 1 takes out steps, 2 ramps, 3 parabolas
  double low = 0.0;               ///< corner of the poles that belong to them
  std::vector<double> sinusoids;  ///< angles of sinusoids
  double width = 0.0;             ///< of their notches
  double high = 1.0;              ///< edge of the low pass
  int order = 2;                  ///< of the low pass; 0: none
  bool bessel = false;            ///< low pass: Bessel, not Butterworth
};

/// H(z) = A_d(z) / A_f(z) as sections: A_d has the poles of what generates the disturbances as zeros, (z - 1)^steps and
/// z^2 - 2 cos(w h) z + 1 for each sinusoid, so each of them leaves only the transient of A_f behind; A_f makes the rest a pass
/// band of gain 1 between `low` and `high` (Butterworth high pass, notches, low pass, all by the bilinear transformation, whose
/// zeros at z = -1 are not part of A_d).
/// Source: A. Kallen, Frequency Domain Adaptive Control, Lund 1992, section 6.3, (6.1) and the filter after it. Errors: steps
/// outside 0 .. 3, order outside 0 .. 16, edges outside 0 .. pi, low not below high, nothing to do.
numerics::Expected<numerics::Sections> disturbance_filter(const DisturbanceDesign& design);

}  // namespace bodeflow::filters
