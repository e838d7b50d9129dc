#include <cmath>

#include "generate/integrate.hpp"
#include "generate/sensors.hpp"

namespace battery {
namespace {

/// Slopes of the currents of the linear circuit for a voltage that is left behind all drops in the stator.
State<2> slope_of(const Motor& m, double voltage, double is, double ir) {
  const double a = m.leakage + m.lm, drop = -m.rr * ir, determinant = a * a - m.lm * m.lm;
  const double e = voltage - m.rs * is;
  return {(a * e - m.lm * drop) / determinant, (a * drop - m.lm * e) / determinant};
}

/// A corroded contact that conducts better one way: its drop has an even part.
Hidden rectifying_contact(const Motor& motor, const Scale& scale, Random& random) {
  const double knee = scale.output_rms * random.log_uniform(0.2, 2.0);
  Hidden h{"rectifying_contact", 0.05, 0.8, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const auto slope = [&](double, double v, const State<2>& x) {
      return slope_of(motor, v - strength * motor.rs * x[0] * std::tanh(x[0] / knee), x[0], x[1]);
    };
    return sampled(d, integrate<2>(d, Between::held, {}, slope, [](const State<2>& x) { return x[0]; }));
  };
  return h;
}

/// A thin conductor whose resistance follows its own losses within a period of the excitation.
Hidden thermal_resistance(const Motor& motor, const Scale& scale, Random& random) {
  const double warm_up = random.log_uniform(0.05, 0.6);
  Hidden h{"thermal_resistance", 0.05, 0.6, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const auto slope = [&](double, double v, const State<3>& x) {
      const auto i = slope_of(motor, v - strength * motor.rs * x[2] * x[0], x[0], x[1]);
      const double loss = (x[0] / scale.output_rms) * (x[0] / scale.output_rms);
      return State<3>{i[0], i[1], (loss - x[2]) / warm_up};
    };
    return sampled(d, integrate<3>(d, Between::held, {}, slope, [](const State<3>& x) { return x[0]; }));
  };
  return h;
}

/// The link's voltage sags with the power taken from it, and the modulator does not know.
Hidden supply_sag(const Motor& motor, const Scale& scale, Random& random) {
  const double recovery = random.log_uniform(5e-3, 0.1), power = scale.output_rms * motor.voltage_rms;
  Hidden h{"supply_sag", 0.05, 0.4, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const auto slope = [&](double, double v, const State<3>& x) {
      const auto i = slope_of(motor, v * (1.0 - strength * x[2]), x[0], x[1]);
      return State<3>{i[0], i[1], (v * x[0] / power - x[2]) / recovery};
    };
    return sampled(d, integrate<3>(d, Between::held, {}, slope, [](const State<3>& x) { return x[0]; }));
  };
  return h;
}

}  // namespace

const std::vector<Maker<Motor>>& motor_strangers() {
  static const std::vector<Maker<Motor>> all = {
      {"rectifying_contact", rectifying_contact},
      {"thermal_resistance", thermal_resistance},
      {"gain_wobble", of<Motor, gain_wobble>},
      {"clock_wander", of<Motor, clock_wander>},
      {"supply_sag", supply_sag},
      {"level_delay", of<Motor, level_delay>},
      {"attack_decay", of<Motor, attack_decay>},
      {"squared_crosstalk", of<Motor, squared_crosstalk>},
  };
  return all;
}

}  // namespace battery
