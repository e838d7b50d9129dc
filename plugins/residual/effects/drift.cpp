#include "effects/drift.hpp"

#include "effects/words.hpp"

namespace bodeflow::residual {

void Drift::describe(DescribeEffect& effect) {
  effect.id("residual.drift")
      .summary("The reading of the sensor runs away evenly")
      .doc("y + b + r t, t since the record began; the rate r is the same in all records, the level b has a value in each.")
      .acts(Acts::output)
      .nonstationary();
}

std::vector<FitParameter> Drift::parameters(const Situation& s) const {
  const double size = size_or_one(s.output_rms);
  return {real("drift", per(s.output_unit, "s"), size / size_or_one(s.duration_s)).says("added to the output in a second"),
          real("drift_level", s.output_unit, size).own_in_each_record().says("added to the output when the record begins")};
}

std::vector<std::vector<double>> Drift::starts(const Situation& s) const { return {{0.0, s.residual_mean}}; }

std::string Drift::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "reading of the sensor that runs away by " + quantity(value[0], std[0], s.output_unit) + " a second";
}

double Drift::map(const double* p, double x, double time_s, double*) const { return x + p[1] + p[0] * time_s; }

}  // namespace bodeflow::residual
