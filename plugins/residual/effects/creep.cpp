#include "effects/creep.hpp"

#include <limits>

#include "effects/response_words.hpp"

namespace bodeflow::residual {

void Creep::describe(DescribeEffect& effect) {
  effect.id("residual.creep")
      .summary("The suspension creeps: it is softer the slower it moves.")
      .doc(
          "Stiffness K + k log10(s / w0), w0 = 2 pi 1 Hz: K is the stiffness at 1 Hz, k what it gains in a decade of frequency; "
          "on the "
          "frequency axis it also loses k pi / (2 ln 10) in quadrature, at all frequencies alike. For small k / K the same as "
          "the "
          "compliance C (1 - lambda log10(s / w0)) of Knudsen and Jensen. Nothing is added at frequency 0, where the law has no "
          "value.")
      .reference(
          "M. H. Knudsen, J. G. Jensen, Low-frequency loudspeaker models that include suspension creep, J. Audio Eng. Soc. 41 "
          "(1993) 3")
      .acts(Acts::immittance, {"spring"});
}

std::vector<FitParameter> Creep::parameters(const Situation& s) const {
  return {real("creep", lines::ratio_unit(s.place.reaction_unit, s.place.stored_unit), 0.1 * lines::coefficient_of(s))
              .between(0.0, std::numeric_limits<double>::infinity())
              .says("growth of the stiffness in a decade of frequency")};
}

std::vector<std::vector<double>> Creep::starts(const Situation& s) const { return {{0.0}, {0.1 * lines::coefficient_of(s)}}; }

std::string Creep::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "creep of the suspension, whose stiffness grows by " +
         lines::with_std(value[0], std[0], lines::ratio_unit(s.place.reaction_unit, s.place.stored_unit)) +
         " in a decade of frequency";
}

std::complex<double> Creep::transfer(const double* p, std::complex<double> s) const {
  if (std::abs(s) <= 0.0) return 0.0;
  return p[0] * std::log10(s / lines::kTwoPi) / s;
}

}  // namespace bodeflow::residual
