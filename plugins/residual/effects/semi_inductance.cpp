#include "effects/semi_inductance.hpp"

#include "effects/response_words.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kReferenceHz = 1000.0;

}  // namespace

void SemiInductance::describe(DescribeEffect& effect) {
  effect.id("residual.semi_inductance")
      .summary("Eddy currents in the solid iron around the coil: its impedance grows slower than that of an inductance.")
      .doc(
          "X (s / w0)^n, 0 < n < 1, w0 = 2 pi 1 kHz, in series with the inductance of the base model: X is its magnitude at 1 "
          "kHz, its phase is "
          "n 90 degrees everywhere. n = 1/2 for iron much thicker than the skin depth, measured coils of loudspeakers have 0.5 "
          "to "
          "0.8. Written as K s^n, K = X / w0^n.")
      .reference(
          "J. Vanderkooy, A model of loudspeaker driver impedance incorporating eddy currents in the pole structure, J. Audio "
          "Eng. Soc. 37 (1989) 119")
      .reference("W. M. Leach, Loudspeaker voice-coil inductance losses, J. Audio Eng. Soc. 50 (2002) 442")
      .acts(Acts::immittance, {"coil"});
}

std::vector<FitParameter> SemiInductance::parameters(const Situation&) const {
  return {positive("semi_inductance_reactance", "ohm").says("magnitude of its impedance at 1 kHz"),
          real("semi_inductance_exponent", "1", 0.1).between(0.0, 1.0).says("its power of s: 1 an inductance, 0 a resistance")};
}

std::vector<std::vector<double>> SemiInductance::starts(const Situation& s) const {
  const double reactance = lines::kTwoPi * kReferenceHz / lines::coefficient_of(s);  // the coefficient is 1 / inductance
  return {{reactance, 0.7}, {reactance, 0.5}, {0.2 * reactance, 0.5}};
}

std::string SemiInductance::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "semi-inductance of the coil (eddy currents in the iron), " + lines::with_std(value[0], std[0], "ohm") +
         " at 1 kHz, power " + lines::with_std(value[1], std[1], "1", 3) + " of the frequency";
}

std::complex<double> SemiInductance::transfer(const double* p, std::complex<double> s) const {
  if (std::abs(s) <= 0.0) return 0.0;
  return p[0] * std::pow(s / (lines::kTwoPi * kReferenceHz), p[1]);
}

}  // namespace bodeflow::residual
