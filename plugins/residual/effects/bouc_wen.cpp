#include "effects/bouc_wen.hpp"

#include <cmath>

#include "effects/words.hpp"

namespace bodeflow::residual {

void BoucWen::describe(DescribeEffect& effect) {
  effect.id("residual.bouc_wen")
      .summary("Hysteresis: the force depends on where the deflection came from, as in rubber, wire ropes or iron")
      .doc(
          "Beside the linear spring the force k X z, X dz/dx = 1 - |z| while it moves towards the limit and 1 + m |z| on the way "
          "back; solved in closed form over each step. It is Wen's law with n = 1 and m = (beta - gamma) / (beta + gamma), m >= "
          "0 so that closed cycles take energy. It depends on the path, not on the velocity. Wrong for hysteresis that forgets "
          "with time (creep).")
      .reference("R. Bouc, Forced vibration of mechanical systems with hysteresis, 4th Conf. Nonlinear Oscillation, 1967")
      .reference("Y.-K. Wen, Method for random vibration of hysteretic systems, ASCE J. Engineering Mechanics 102 (1976) 249")
      .acts(Acts::law, {"spring", "coupling", "core"})
      .memory(3)
      .steps_per_sample(4);
}

std::vector<FitParameter> BoucWen::parameters(const Situation& s) const {
  return {positive("hysteresis_stiffness", per(s.place.reaction_unit, s.place.stored_unit)).says("of the part that remembers"),
          positive("hysteresis_reach", s.place.stored_unit).says("deflection after which it gives way"),
          positive("hysteresis_return", "1").says("how much steeper the way back is")};
}

std::vector<std::vector<double>> BoucWen::starts(const Situation& s) const {
  const double stored = size_or_one(s.place.stored), stiffness = stiffness_of(s.place);
  return {{0.1 * stiffness, 0.2 * stored, 0.5}, {0.1 * stiffness, stored, 0.5}};
}

std::string BoucWen::sentence(std::span<const double> value, std::span<const double> std, const Situation& s) const {
  return "hysteresis in the " + spoken(s.place.name) + ": up to " + digits(value[0] * value[1], 3) + " " + s.place.reaction_unit +
         " depend on where it came from, and change after " + quantity(value[1], std[1], s.place.stored_unit);
}

Reaction BoucWen::react(const double* p, const Signals& s, const double* memory, double* next) const {
  const double path = memory[2] > 0.0 ? (s.stored - memory[1]) / p[1] : 0.0, towards = path >= 0.0 ? 1.0 : -1.0;
  double size = towards * memory[0], left = std::abs(path), slope = 0.0;  // of z in the direction of the movement
  if (size < 0.0) {
    const double back = -size, turn = std::log1p(p[2] * back) / p[2];  // path on which z returns to 0
    if (left < turn) {
      size = -(back * std::exp(-p[2] * left) + std::expm1(-p[2] * left) / p[2]);
      slope = 1.0 - p[2] * size;
      left = 0.0;
    } else {
      size = 0.0;
      left -= turn;
    }
  }
  if (size >= 0.0) {
    size = 1.0 - (1.0 - size) * std::exp(-left);
    slope = 1.0 - size;
  }
  next[0] = towards * size;
  next[1] = s.stored;
  next[2] = 1.0;
  return {p[0] * p[1] * next[0], 0.0, p[0] * slope};
}

}  // namespace bodeflow::residual
