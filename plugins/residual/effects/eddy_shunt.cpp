#include "effects/eddy_shunt.hpp"

#include "effects/response_words.hpp"

namespace bodeflow::residual {

void EddyShunt::describe(DescribeEffect& effect) {
  effect.id("residual.eddy_shunt")
      .summary("Eddy currents in the iron beside the coil: a part of its inductance has a resistance across it.")
      .doc(
          "s L R / (R + s L) in series with the inductance of the base model: an inductance L below the frequency R / (2 pi L), "
          "a resistance R "
          "above it. One ring of current; many of them make a semi-inductance.")
      .reference("A. N. Thiele, Loudspeakers in vented boxes, J. Audio Eng. Soc. 19 (1971) 382")
      .acts(Acts::immittance, {"coil"});
}

std::vector<FitParameter> EddyShunt::parameters(const Situation&) const {
  return {positive("eddy_inductance", "H").says("inductance that the eddy currents bridge"),
          positive("eddy_resistance", "ohm").says("resistance across it")};
}

std::vector<std::vector<double>> EddyShunt::starts(const Situation& s) const {
  const double inductance = 1.0 / lines::coefficient_of(s), middle = lines::middle_omega(s), highest = lines::highest_omega(s);
  return {{inductance, inductance * middle},
          {inductance, inductance * std::sqrt(middle * highest)},
          {3.0 * inductance, inductance * highest}};
}

std::string EddyShunt::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "eddy currents beside the coil, " + lines::with_std(value[1], std[1], "ohm") + " across " +
         lines::with_std(1e3 * value[0], 1e3 * std[0], "mH");
}

std::complex<double> EddyShunt::transfer(const double* p, std::complex<double> s) const {
  return s * p[0] * p[1] / (p[1] + s * p[0]);
}

}  // namespace bodeflow::residual
