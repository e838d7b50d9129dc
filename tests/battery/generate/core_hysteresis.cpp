#include "generate/core_hysteresis.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "generate/integrate.hpp"

namespace battery {
namespace {

/// The core's magnetising current has a part with hysteresis: elastic-plastic elements over the main flux, whose yield points
/// are spread.
class Core {
 public:
  Core(const Motor& m, double flux, double current) : m_(m), flux_(flux) {
    for (std::size_t k = 0; k < kElements; ++k) {
      yield_[k] = flux * static_cast<double>(k + 1) / static_cast<double>(kElements);
      slope_[k] = current / (flux * static_cast<double>(kElements) * 0.5);
    }
  }

  /// The main flux for flux linkages of stator and rotor: currents (linkage - flux) / leakage add up to what magnetises.
  double flux(double stator, double rotor) const {
    double psi = flux_now_;
    for (int n = 0; n < 60; ++n) {
      double rest = (stator + rotor - 2.0 * psi) / m_.leakage - psi / m_.lm, gain = -2.0 / m_.leakage - 1.0 / m_.lm;
      for (std::size_t k = 0; k < kElements; ++k) {
        const double free = element_[k] + psi - flux_now_;
        rest -= slope_[k] * std::clamp(free, -yield_[k], yield_[k]);
        if (std::abs(free) < yield_[k]) gain -= slope_[k];
      }
      const double change = rest / gain;
      psi -= change;
      if (std::abs(change) <= 1e-13 * flux_) break;
    }
    return psi;
  }
  void settle(double psi) {
    for (std::size_t k = 0; k < kElements; ++k) element_[k] = std::clamp(element_[k] + psi - flux_now_, -yield_[k], yield_[k]);
    flux_now_ = psi;
  }

 private:
  static constexpr std::size_t kElements = 8;
  Motor m_;
  double flux_, flux_now_ = 0.0;
  std::array<double, kElements> yield_{}, slope_{}, element_{};
};

}  // namespace

Hidden core_hysteresis(const Motor& motor, const Scale& scale, Random& random) {
  const double flux = motor.lm * scale.output_rms * random.uniform(0.3, 1.0);
  Hidden h{"bouc_wen", 0.1, 1.5, {}};
  h.run = [=](const Drive& d, double strength, Random&) {
    Core core(motor, flux, strength * flux / motor.lm);
    State<2> x{};  // flux linkages of stator and rotor
    const double step = d.sample_time / static_cast<double>(kSubsteps);
    Series y(d.all_samples() * kSubsteps);
    for (std::size_t n = 0; n < y.size(); ++n) {
      y[n] = (x[0] - core.flux(x[0], x[1])) / motor.leakage;
      x = runge_kutta(x, step, [&](double c, const State<2>& s) {
        const double psi = core.flux(s[0], s[1]);
        return State<2>{input_at(d, Between::held, n, c) - motor.rs * (s[0] - psi) / motor.leakage,
                        -motor.rr * (s[1] - psi) / motor.leakage};
      });
      core.settle(core.flux(x[0], x[1]));
    }
    return sampled(d, y);
  };
  return h;
}

}  // namespace battery
