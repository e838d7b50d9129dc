#include <algorithm>
#include <cmath>
#include <numbers>

#include "generate/integrate.hpp"
#include "generate/sensors.hpp"
#include "generate/stick_slip.hpp"

namespace battery {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

using Position = State<2>;
double position(const Position& x) { return x[0]; }

/// Samples of an oscillator on which a force more(x, v) acts against the motion.
template <class Force>
Series with_force(const Oscillator& o, const Drive& d, Force more) {
  return sampled(d, integrate<2>(
                        d, Between::smooth, {},
                        [&](double, double f, const Position& x) {
                          return Position{x[1], (f - o.damping * x[1] - o.stiffness * x[0] - more(x[0], x[1])) / o.mass};
                        },
                        position));
}

Hidden cubic_stiffness(const Oscillator& o, const Scale& scale, Random& random) {
  const double sign = random.chance(0.8) ? 1.0 : -0.03;  // a softening spring only weakly: it must stay stable
  const auto k3 = [=](double strength) { return sign * strength * o.stiffness / (scale.output_rms * scale.output_rms); };
  Hidden h{"cubic_stiffness", 0.01, 1.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    return with_force(o, d, [k = k3(strength)](double x, double) { return k * x * x * x; });
  };
  h.values = [=](double strength) { return std::vector<Value>{{"cubic stiffness", "N/m^3", k3(strength)}}; };
  return h;
}

Hidden quadratic_stiffness(const Oscillator& o, const Scale& scale, Random& random) {
  const double sign = random.chance(0.5) ? 1.0 : -1.0;
  const auto k2 = [=](double strength) { return sign * strength * o.stiffness / scale.output_rms; };
  Hidden h{"quadratic_stiffness", 0.01, 0.1, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    return with_force(o, d, [k = k2(strength)](double x, double) { return k * x * x; });
  };
  h.values = [=](double strength) { return std::vector<Value>{{"quadratic stiffness", "N/m^2", k2(strength)}}; };
  return h;
}

Hidden quadratic_damping(const Oscillator& o, const Scale& scale, Random&) {
  const double velocity = std::sqrt(o.stiffness / o.mass) * scale.output_rms;
  const auto c2 = [=](double strength) { return strength * o.damping / velocity; };
  Hidden h{"quadratic_damping", 0.1, 3.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    return with_force(o, d, [c = c2(strength)](double, double v) { return c * v * std::abs(v); });
  };
  h.values = [=](double strength) { return std::vector<Value>{{"quadratic damping", "N s^2/m^2", c2(strength)}}; };
  return h;
}

/// Stops with a stiffness of their own on both sides of a gap.
Hidden stop(const Oscillator& o, const Scale& scale, Random& random) {
  const double hard = o.stiffness * random.log_uniform(0.2, 5.0);
  const auto gap = [=](double strength) { return scale.output_peak * std::exp(-strength); };
  Hidden h{"stop", 0.3, 1.5, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    return with_force(o, d, [hard, free = gap(strength)](double x, double) { return hard * (x - std::clamp(x, -free, free)); });
  };
  h.values = [=](double strength) { return std::vector<Value>{{"gap", "m", gap(strength)}, {"stiffness", "N/m", hard}}; };
  return h;
}

Hidden coulomb_friction(const Oscillator& o, const Scale& scale, Random&) {
  Hidden h{"coulomb_friction", 0.01, 0.25, {}};
  h.run = [=](const Drive& d, double strength, Random&) { return sampled(d, stick_slip(o, strength * scale.input_rms, d)); };
  h.values = [=](double strength) { return std::vector<Value>{{"friction", "N", strength * scale.input_rms}}; };
  return h;
}

/// A sensor's linkage with free travel: it is pushed at either end and rests between.
Hidden play(const Oscillator& o, const Scale& scale, Random&) {
  Hidden h{"play", 0.02, 0.5, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    Series fine = o.clean(d);
    const double half = 0.5 * strength * scale.output_rms;
    double shown = 0.0;
    for (double& x : fine) x = shown = std::clamp(shown, x - half, x + half);
    return sampled(d, fine);
  };
  h.values = [=](double strength) { return std::vector<Value>{{"half travel", "m", 0.5 * strength * scale.output_rms}}; };
  return h;
}

/// A second body on a spring of its own, moved by the same force: y = x + z.
Hidden extra_mode(const Oscillator& o, const Scale&, Random& random) {
  const double f = random.chance(0.3) ? random.uniform(3.0, 6.0) : random.log_uniform(15.0, 40.0), omega = kTwoPi * f;
  const double ratio = random.uniform(0.01, 0.05), sign = random.chance(0.5) ? 1.0 : -1.0;
  Hidden h{"extra_mode", 0.02, 1.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const auto slope = [&](double, double force, const State<4>& x) {
      return State<4>{x[1], (force - o.damping * x[1] - o.stiffness * x[0]) / o.mass, x[3],
                      sign * strength * force / o.mass - 2.0 * ratio * omega * x[3] - omega * omega * x[2]};
    };
    return sampled(d, integrate<4>(d, Between::smooth, {}, slope, [](const State<4>& x) { return x[0] + x[2]; }));
  };
  h.values = [=](double) { return std::vector<Value>{{"frequency", "Hz", f}}; };
  return h;
}

Hidden delay(const Oscillator& o, const Scale&, Random&) {
  Hidden h{"delay", 0.1, 1.6, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const Series fine = o.clean(d);
    Series y(d.samples());
    for (std::size_t n = 0; n < y.size(); ++n) {
      y[n] = interpolated(fine, (static_cast<double>(n + kSettling * d.period) - strength) * static_cast<double>(kSubsteps));
    }
    return y;
  };
  h.values = [=](double strength) { return std::vector<Value>{{"delay", "s", strength * o.sample_time()}}; };
  return h;
}

Hidden sensor_lag(const Oscillator& o, const Scale&, Random&) {
  Hidden h{"sensor_lag", 0.1, 1.6, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    std::vector<Complex> c;
    for (std::size_t j = 0; j < d.lines.size(); ++j) {
      const double omega = d.omega(j);
      c.push_back(d.line(j) * o.response(o.parameters(), omega) / Complex(1.0, omega * strength * d.sample_time));
    }
    return from_coefficients(d, c);
  };
  h.values = [=](double strength) { return std::vector<Value>{{"lag", "s", strength * o.sample_time()}}; };
  return h;
}

/// A spring with hysteresis (R. Bouc 1967, Y. K. Wen 1976): force share k z beside k x, z' = v - |v| |z / y|^(n-1) z / y (b + (1
/// - b) sign(v z)).
Hidden bouc_wen(const Oscillator& o, const Scale& scale, Random& random) {
  const double yield = scale.output_rms * random.log_uniform(0.3, 1.5), n = random.uniform(1.0, 2.5),
               b = random.uniform(0.4, 0.8);
  Hidden h{"bouc_wen", 0.02, 0.5, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const auto slope = [&](double, double f, const State<3>& x) {
      const double z = x[2] / yield, power = std::pow(std::abs(z), n);
      const double hysteresis = x[1] - power * (b * std::abs(x[1]) * (z < 0.0 ? -1.0 : 1.0) + (1.0 - b) * x[1]);
      return State<3>{x[1], (f - o.damping * x[1] - o.stiffness * (x[0] + strength * x[2])) / o.mass, hysteresis};
    };
    return sampled(d, integrate<3>(d, Between::smooth, {}, slope, [](const State<3>& x) { return x[0]; }));
  };
  return h;
}

}  // namespace

const std::vector<Maker<Oscillator>>& oscillator_effects() {
  static const std::vector<Maker<Oscillator>> all = {
      {"cubic_stiffness", cubic_stiffness},
      {"coulomb_friction", coulomb_friction},
      {"play", play},
      {"extra_mode", extra_mode},
      {"delay", delay},
      {"quadratic_damping", quadratic_damping},
      {"stop", stop},
      {"hum", of<Oscillator, hum>},
      {"offset", of<Oscillator, offset>},
      {"bouc_wen", bouc_wen},
      {"quadratic_stiffness", quadratic_stiffness},
      {"sensor_lag", sensor_lag},
      {"clipping", of<Oscillator, clipping>},
  };
  return all;
}

}  // namespace battery
