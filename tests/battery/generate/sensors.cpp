#include "generate/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "generate/integrate.hpp"

namespace battery {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Samples looked at `late(n)` seconds after they were due; n is a sample of the simulation, settling included.
template <class Late>
Series sampled_late(const Drive& d, const Series& fine, Late late) {
  const double h = d.sample_time / static_cast<double>(kSubsteps);
  Series y(d.samples());
  for (std::size_t n = 0; n < y.size(); ++n) {
    const std::size_t at = n + kSettling * d.period;
    y[n] = interpolated(fine, static_cast<double>(at * kSubsteps) - late(at) / h);
  }
  return y;
}

}  // namespace

double interpolated(const Series& fine, double substep) {
  const double last = static_cast<double>(fine.size()) - 3.0;
  const double at = std::clamp(std::floor(substep), 1.0, last);
  const double x = substep - at;
  const double* y = fine.data() + static_cast<std::size_t>(at);
  return y[-1] * (-x * (x - 1.0) * (x - 2.0) / 6.0) + y[0] * ((x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0) +
         y[1] * (-(x + 1.0) * x * (x - 2.0) / 2.0) + y[2] * ((x + 1.0) * x * (x - 1.0) / 6.0);
}

Hidden hum(PlantPointer plant, const Scale& scale, Random& random) {
  const double f = random.uniform(49.96, 50.04), third = 150.0 < 0.4 / plant->sample_time() ? random.uniform(0.1, 0.5) : 0.0;
  Hidden h{"hum", 0.01, 1.0, {}};
  h.run = [=](const Drive& d, double strength, Random& r) {
    Series y = sampled(d, plant->clean(d));
    const double a = strength * scale.output_rms * std::sqrt(2.0), phase = r.uniform(0.0, kTwoPi),
                 phase3 = r.uniform(0.0, kTwoPi);
    for (std::size_t n = 0; n < y.size(); ++n) {
      const double angle = kTwoPi * f * d.sample_time * static_cast<double>(n);
      y[n] += a * (std::sin(angle + phase) + third * std::sin(3.0 * angle + phase3));
    }
    return y;
  };
  h.values = [=](double) { return std::vector<Value>{{"frequency", "Hz", f}}; };
  return h;
}

Hidden offset(PlantPointer plant, const Scale& scale, Random& random) {
  const double sign = random.chance(0.5) ? 1.0 : -1.0;
  Hidden h{"offset", 0.01, 1.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    Series y = sampled(d, plant->clean(d));
    for (double& v : y) v += sign * strength * scale.output_rms;
    return y;
  };
  h.values = [=, unit = plant->output_unit()](double strength) {
    return std::vector<Value>{{"offset", unit, sign * strength * scale.output_rms}};
  };
  return h;
}

Hidden clipping(PlantPointer plant, const Scale& scale, Random&) {
  const auto level = [=](double strength) { return scale.output_peak * std::exp(-strength); };
  Hidden h{"clipping", 0.3, 1.5, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    Series y = sampled(d, plant->clean(d));
    for (double& v : y) v = std::clamp(v, -level(strength), level(strength));
    return y;
  };
  h.values = [=, unit = plant->output_unit()](double strength) { return std::vector<Value>{{"level", unit, level(strength)}}; };
  return h;
}

Hidden gain_wobble(PlantPointer plant, const Scale&, Random& random) {
  const Wander wander = draw_wander(*plant, random);
  Hidden h{"gain_wobble", 0.02, 0.5, {}};
  h.run = [=](const Drive& d, double strength, Random& r) {
    Series y = sampled(d, plant->clean(d));
    const Series w = wander_signal(wander, d, r);
    for (std::size_t n = 0; n < y.size(); ++n) y[n] *= 1.0 + strength * w[n + kSettling * d.period];
    return y;
  };
  return h;
}

Hidden clock_wander(PlantPointer plant, const Scale&, Random& random) {
  const Wander wander = draw_wander(*plant, random);
  Hidden h{"clock_wander", 0.05, 3.0, {}};
  h.run = [=](const Drive& d, double strength, Random& r) {
    const Series w = wander_signal(wander, d, r);
    return sampled_late(d, plant->clean(d), [&](std::size_t n) { return strength * d.sample_time * w[n]; });
  };
  return h;
}

Hidden level_delay(PlantPointer plant, const Scale& scale, Random& random) {
  const double half = scale.output_rms * random.uniform(0.5, 1.5);
  Hidden h{"level_delay", 0.1, 6.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    const Series fine = plant->clean(d);
    return sampled_late(d, fine, [&](std::size_t n) {
      const double size = std::abs(fine[n * kSubsteps]) / half;
      return strength * d.sample_time * size * size / (1.0 + size * size);
    });
  };
  return h;
}

Hidden attack_decay(PlantPointer plant, const Scale&, Random& random) {
  const double difference = random.uniform(0.5, 0.9) * (random.chance(0.5) ? 1.0 : -1.0);
  Hidden h{"attack_decay", 0.1, 3.0, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    Series fine = plant->clean(d);
    const double step = d.sample_time / static_cast<double>(kSubsteps), lag = strength * d.sample_time;
    const double up = -std::expm1(-step / (lag * (1.0 + difference))), down = -std::expm1(-step / (lag * (1.0 - difference)));
    double shown = 0.0;
    for (double& v : fine) {
      shown += (v > shown ? up : down) * (v - shown);
      v = shown;
    }
    return sampled(d, fine);
  };
  return h;
}

Hidden squared_crosstalk(PlantPointer plant, const Scale& scale, Random& random) {
  const double lag = plant->sample_time() * random.log_uniform(20.0, 200.0);
  Hidden h{"squared_crosstalk", 0.02, 0.6, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    Series y = plant->clean(d);
    const double step = -std::expm1(-d.sample_time / static_cast<double>(kSubsteps) / lag);
    double heard = 0.0;
    for (std::size_t n = 0; n < y.size(); ++n) {
      const double u = d.half_steps[(2 * n) % d.half_steps.size()] / scale.input_rms;
      heard += step * (u * u - 1.0 - heard);
      y[n] += strength * scale.output_rms * std::sqrt(lag / d.sample_time) * heard;
    }
    return sampled(d, y);
  };
  return h;
}

}  // namespace battery
