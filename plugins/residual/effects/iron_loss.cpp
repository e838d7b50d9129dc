#include "effects/iron_loss.hpp"

#include <limits>

#include "effects/response_words.hpp"

namespace bodeflow::residual {
namespace {

/// A tenth of the susceptance of the magnetising inductance in the middle of the band.
double typical(const Situation& s) { return 0.1 * lines::coefficient_of(s) / lines::middle_omega(s); }

}  // namespace

void IronLoss::describe(DescribeEffect& effect) {
  effect.id("residual.iron_loss")
      .summary("The iron of the core has losses that the model leaves out.")
      .doc(
          "A resistance beside the magnetising inductance: eddy currents in laminations that are thin against the skin depth. "
          "Hysteresis losses are not of this kind.")
      .acts(Acts::immittance, {"core"});
}

std::vector<FitParameter> IronLoss::parameters(const Situation& s) const {
  return {real("iron_loss_conductance", "S", typical(s))
              .between(0.0, std::numeric_limits<double>::infinity())
              .says("current of the losses for a unit of voltage across the core")};
}

std::vector<std::vector<double>> IronLoss::starts(const Situation& s) const { return {{0.0}, {typical(s)}}; }

std::string IronLoss::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  const double resistance = 1.0 / value[0];
  return "losses in the iron, " + lines::with_std(resistance, resistance * std[0] / value[0], "ohm") +
         " beside the magnetising inductance";
}

std::complex<double> IronLoss::transfer(const double* p, std::complex<double>) const { return p[0]; }

}  // namespace bodeflow::residual
