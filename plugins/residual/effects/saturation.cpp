#include "effects/saturation.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void Saturation::describe(DescribeEffect& effect) {
  effect.id("residual.saturation")
      .summary("The iron saturates: the inductance falls with the current")
      .doc(
          "In addition to the linear magnetising current flows psi (a psi^2 + b psi^4) / (1 + c psi^4). It can be told from a "
          "measurement how far the inductance falls, hardly what each of the three is. Wrong where iron remembers (hysteresis).")
      .acts(Acts::law, {"core"});
}

std::vector<FitParameter> Saturation::parameters(const Situation& s) const {
  const std::string& flux = s.place.stored_unit;
  return {positive("saturation_a", per(s.place.reaction_unit, flux, 3)).says("third power of the flux"),
          positive("saturation_b", per(s.place.reaction_unit, flux, 5)).says("fifth power of the flux"),
          positive("saturation_c", per("1", flux, 4)).says("where it becomes straight again")};
}

std::vector<std::vector<double>> Saturation::starts(const Situation& s) const {
  const double flux = size_or_one(s.place.stored), square = flux * flux, slope = stiffness_of(s.place);
  std::vector<std::vector<double>> starts;
  for (const double rise : {0.1, 0.4, 1.6})
    starts.push_back({slope * rise / square, slope * rise / (square * square), 0.1 / (square * square)});
  return starts;
}

std::string Saturation::sentence(std::span<const double> value, std::span<const double>, const Situation& s) const {
  Signals top;
  top.stored = s.place.stored;
  const double fall = 1.0 - 1.0 / (1.0 + react(value.data(), top, nullptr, nullptr).by_stored / stiffness_of(s.place));
  return "saturation of the " + spoken(s.place.name) + ": the incremental inductance falls by " + digits(100.0 * fall, 2) +
         " % up to the largest flux of the records, " + digits(s.place.stored, 2) + " " + s.place.stored_unit;
}

Reaction Saturation::react(const double* p, const Signals& s, const double*, double*) const {
  const double flux = s.stored, x = flux * flux, rise = x * (p[0] + x * p[1]), part = 1.0 / (1.0 + p[2] * x * x);
  const double slope = x * (2.0 * p[0] + x * (4.0 * p[1] - 2.0 * p[0] * p[2] * x)) * part * part;
  return {flux * rise * part, 0.0, rise * part + slope};
}

}  // namespace bodeflow::residual
