#include <algorithm>
#include <cmath>
#include <numbers>

#include "generate/core_hysteresis.hpp"
#include "generate/integrate.hpp"
#include "generate/sensors.hpp"
#include "generate/switching.hpp"

namespace battery {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Slopes of the currents of stator and rotor, where the magnetising branch has the inductance dflux at its present current.
State<2> circuit_slope(const Motor& m, double voltage, double rs, double dflux, double is, double ir) {
  const double a = m.leakage + dflux, e1 = voltage - rs * is, e2 = -m.rr * ir, determinant = a * a - dflux * dflux;
  return {(a * e1 - dflux * e2) / determinant, (a * e2 - dflux * e1) / determinant};
}

/// The inverter's dead time, switching instant by switching instant.
Hidden dead_time(const Motor& motor, const Scale&, Random& random) {
  Switching s;
  s.link = motor.voltage_rms * random.uniform(9.0, 16.0);  // no peak of the command is beyond half of it
  s.periods_per_sample = std::vector<std::size_t>{10, 16, 20}[random.below(3)];
  Hidden h{"dead_time", 0.05, 0.6, {}};
  const auto lost = [volts = motor.voltage_rms](double strength) { return strength * volts; };
  h.run = [=](const Drive& d, double strength, Random&) {
    Switching with = s;
    with.dead_time = lost(strength) / s.link * d.sample_time / static_cast<double>(s.periods_per_sample);
    return switched_current(motor, with, d);
  };
  h.values = [=](double strength) { return std::vector<Value>{{"voltage", "V", lost(strength)}}; };
  return h;
}

/// Flux of the main inductance over its current: arctan, or Langevin's function.
Hidden saturation(const Motor& motor, const Scale& scale, Random& random) {
  const bool langevin = random.chance(0.5);
  Hidden h{"saturation", 0.1, 3.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const double knee = scale.output_rms / strength;
    const auto inductance = [=](double im) {
      const double x = im / knee;
      if (!langevin) return motor.lm / (1.0 + x * x);
      if (std::abs(x) < 1e-2) return motor.lm * (1.0 - x * x / 5.0);
      const double s = std::sinh(std::min(std::abs(x), 300.0));
      return motor.lm * 3.0 * (1.0 / (x * x) - 1.0 / (s * s));
    };
    const auto slope = [&](double, double v, const State<2>& x) {
      return circuit_slope(motor, v, motor.rs, inductance(x[0] + x[1]), x[0], x[1]);
    };
    return sampled(d, integrate<2>(d, Between::held, {}, slope, [](const State<2>& x) { return x[0]; }));
  };
  return h;
}

Hidden delay(const Motor& motor, const Scale&, Random&) {
  Hidden h{"delay", 0.1, 1.6, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    return sampled(d, held_response(motor.modes(), d, strength * d.sample_time));
  };
  h.values = [=](double strength) { return std::vector<Value>{{"delay", "s", strength * motor.sample_time()}}; };
  return h;
}

/// The sensor's pole joins the motor's two: partial fractions.
Hidden sensor_lag(const Motor& motor, const Scale&, Random&) {
  Hidden h{"sensor_lag", 0.1, 1.6, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const double pole = -1.0 / (strength * d.sample_time);
    std::vector<Mode> modes = motor.modes();
    double rest = 0.0;
    for (Mode& m : modes) {
      m.residue *= pole / (pole - m.pole);
      rest -= m.residue;
    }
    modes.push_back({pole, rest});
    return sampled(d, held_response(modes, d, 0.0));
  };
  h.values = [=](double strength) { return std::vector<Value>{{"lag", "s", strength * motor.sample_time()}}; };
  return h;
}

/// Rotor bars of a height into which the field diffuses: R z coth z, z^2 = s tau. In the periodic steady state: what the
/// bars change, over the harmonics of the staircase, is added to the exact response without them.
Hidden skin_effect(const Motor& motor, const Scale&, Random& random) {
  const double share = random.uniform(0.6, 1.0);  // of the rotor's resistance that lies in the bars
  Hidden h{"skin_effect", 0.01, 0.3, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const double tau = strength * strength;  // [s]; what changes is proportional to it at low frequencies
    const auto changed = [&](double omega) {
      const Complex z = std::sqrt(Complex(0.0, omega * tau));
      const Complex factor = 1.0 + share * (z / std::tanh(z) - 1.0);
      return motor.admittance(Complex(0.0, omega), factor) - motor.admittance(Complex(0.0, omega), 1.0);
    };
    const double sampling = kTwoPi / d.sample_time;
    std::vector<Complex> c;
    for (std::size_t j = 0; j < d.lines.size(); ++j) {
      const double omega = d.omega(j);
      Complex sum;
      for (int fold = -200; fold <= 200; ++fold) {
        const double w = omega + fold * sampling;
        sum += changed(w) * (1.0 - std::polar(1.0, -omega * d.sample_time)) / Complex(0.0, w * d.sample_time);
      }
      c.push_back(sum * d.line(j));
    }
    Series y = sampled(d, motor.clean(d));
    const Series more = from_coefficients(d, c);
    for (std::size_t n = 0; n < y.size(); ++n) y[n] += more[n];
    return y;
  };
  return h;
}

/// The winding warms up from the beginning of each record: R (1 + strength (1 - exp(-t / warm_up))).
Hidden resistance_drift(const Motor& motor, const Scale&, Random& random) {
  const double record_s = static_cast<double>(kPeriods * kPeriodSamples) * motor.sample_time();
  const double warm_up = record_s * random.uniform(1.0, 4.0), sign = random.chance(0.8) ? 1.0 : -1.0;
  Hidden h{"resistance_drift", 0.1, 0.6, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const auto slope = [&](double t, double v, const State<2>& x) {
      const double rs = motor.rs * (1.0 - sign * strength * std::expm1(-std::max(t, 0.0) / warm_up));
      return circuit_slope(motor, v, rs, motor.lm, x[0], x[1]);
    };
    return sampled(d, integrate<2>(d, Between::held, {}, slope, [](const State<2>& x) { return x[0]; }));
  };
  return h;
}

}  // namespace

const std::vector<Maker<Motor>>& motor_effects() {
  static const std::vector<Maker<Motor>> all = {
      {"dead_time", dead_time},
      {"saturation", saturation},
      {"delay", delay},
      {"skin_effect", skin_effect},
      {"sensor_lag", sensor_lag},
      {"hum", of<Motor, hum>},
      {"resistance_drift", resistance_drift},
      {"offset", of<Motor, offset>},
      {"clipping", of<Motor, clipping>},
      {"bouc_wen", core_hysteresis},
  };
  return all;
}

}  // namespace battery
