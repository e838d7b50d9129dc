#include "motor_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace bodeflow::residual {
namespace {

// e-folds of the slower mode that a simulation runs before its period is taken.
constexpr double kWarmUp = 14.0;

double lost(const Extension& extension, double current, double gain) {
  double sum = 0.0;
  for (const AddedEffect& added : extension) sum += added.effect->effort_lost(added.values.data(), current, gain);
  return sum;
}

/// The motor's equations in current and main flux, with what the effects do to them.
class Circuit {
 public:
  Circuit(const TCircuit& motor, const Extension& extension)
      : rs_(motor.rs),
        rr_(motor.rr),
        leakage_(motor.leakage),
        per_leakage_(1.0 / motor.leakage),
        per_lm_(1.0 / motor.lm),
        extension_(extension) {}

  struct Step {
    double h = 0.0;
    double gain = 0.0;  ///< of the current by a unit of voltage
  };
  Step prepared(double h) const { return {h, 0.5 * h * per_leakage_}; }
  double current() const { return x_.current; }

  void step(const Step& s, double voltage) {
    const double h = s.h, u = voltage - lost(extension_, x_.current, s.gain);
    const State k1 = slope(x_, u);
    const State k2 = slope({x_.current + 0.5 * h * k1.current, x_.flux + 0.5 * h * k1.flux}, u);
    const State k3 = slope({x_.current + 0.5 * h * k2.current, x_.flux + 0.5 * h * k2.flux}, u);
    const State k4 = slope({x_.current + h * k3.current, x_.flux + h * k3.flux}, u);
    x_.current += h / 6.0 * (k1.current + 2.0 * (k2.current + k3.current) + k4.current);
    x_.flux += h / 6.0 * (k1.flux + 2.0 * (k2.flux + k3.flux) + k4.flux);
  }

 private:
  struct State {
    double current = 0.0;
    double flux = 0.0;
  };

  State slope(const State& x, double voltage) const {
    double extra = 0.0, extra_slope = 0.0;
    for (const AddedEffect& added : extension_) {
      const Law law = added.effect->extra_stored(added.values.data(), x.flux);
      extra += law.value;
      extra_slope += law.slope;
    }
    const double magnetising = (x.flux + extra) * per_lm_, inverse = (1.0 + extra_slope) * per_lm_;
    const double a = voltage - rs_ * x.current, b = rr_ * (x.current - magnetising);
    const double flux = (a + b) / (2.0 + leakage_ * inverse);
    return {(a - flux) * per_leakage_, flux};
  }

  double rs_, rr_, leakage_, per_leakage_, per_lm_;
  const Extension& extension_;
  State x_;
};

/// The two modes of the linear motor, each moved exactly while voltage and loss are held.
class Modes {
 public:
  Modes(const MotorModes& modes, const Extension& extension) : modes_(modes), extension_(extension) {}

  struct Step {
    double decay[2], gain[2];
  };
  Step prepared(double h) const {
    Step s;
    for (int i = 0; i < 2; ++i) {
      s.decay[i] = std::exp(modes_.pole[i] * h);
      s.gain[i] = modes_.residue[i] * std::expm1(modes_.pole[i] * h) / modes_.pole[i];
    }
    return s;
  }
  double current() const { return x_[0] + x_[1]; }

  void step(const Step& s, double voltage) {
    const double u = voltage - lost(extension_, current(), s.gain[0] + s.gain[1]);
    for (int i = 0; i < 2; ++i) x_[i] = s.decay[i] * x_[i] + s.gain[i] * u;
  }

 private:
  MotorModes modes_;
  const Extension& extension_;
  double x_[2] = {0.0, 0.0};
};

Eigen::Index modulo(Eigen::Index n, Eigen::Index period) { return (n % period + period) % period; }

/// A piece of a sample period with constant input and steps of one size.
struct Piece {
  Eigen::Index held = 0;  ///< which of the sample's inputs acts
  int steps = 1;
  double step_s = 0.0;
  bool sampled = false;  ///< the current is sampled at its end
};

/// The pieces of one sample period of the input; the current is sampled `offset_s` after it begins, 0 < offset_s <= sample time.
std::vector<Piece> pieces_of(const Timing& t, double offset_s) {
  const double held_s = t.sample_time_s / t.held_per_sample, longest_s = t.sample_time_s / t.steps_per_sample;
  std::vector<Piece> pieces;
  const auto add = [&](Eigen::Index held, double from, double to, bool sampled) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / longest_s - 1e-9)));
    pieces.push_back({held, steps, (to - from) / steps, sampled});
  };
  for (Eigen::Index j = 0; j < t.held_per_sample; ++j) {
    const double from = static_cast<double>(j) * held_s, to = j + 1 == t.held_per_sample ? t.sample_time_s : from + held_s;
    if (offset_s > from && offset_s < to) {
      add(j, from, offset_s, true);
      add(j, offset_s, to, false);
    } else {
      add(j, from, to, offset_s == to);
    }
  }
  return pieces;
}

/// One period of the current after the warm-up.
template <class Motor>
Eigen::VectorXd run(Motor motor, const Timing& t, const Eigen::VectorXd& voltage, Eigen::Index warm_up) {
  const Eigen::Index period = voltage.size() / t.held_per_sample;
  // y(n T - d) = y((n - late) T + offset), 0 < offset <= T: what is sampled during input period m is output m + late.
  const double whole = std::floor(t.delay_s / t.sample_time_s);
  const double offset_s = t.sample_time_s - (t.delay_s - whole * t.sample_time_s);
  const Eigen::Index late = static_cast<Eigen::Index>(whole) + 1;
  const std::vector<Piece> pieces = pieces_of(t, offset_s);
  std::vector<typename Motor::Step> steps;
  for (const Piece& piece : pieces) steps.push_back(motor.prepared(piece.step_s));
  Eigen::VectorXd current(period);
  for (Eigen::Index m = -warm_up; m < period; ++m) {
    const double* held = voltage.data() + modulo(m, period) * t.held_per_sample;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Piece& piece = pieces[i];
      for (int s = 0; s < piece.steps; ++s) motor.step(steps[i], held[piece.held]);
      if (piece.sampled && m >= 0) current[modulo(m + late, period)] = motor.current();
    }
  }
  return current;
}

}  // namespace

Eigen::VectorXd simulate(const Eigen::Vector4d& parameters, const Timing& t, const Eigen::VectorXd& voltage,
                         const Extension& extension) {
  const MotorModes modes = motor_modes(parameters);
  const double period = static_cast<double>(voltage.size()) / t.held_per_sample;
  const double samples = std::clamp(std::ceil(kWarmUp / (-modes.pole[1] * t.sample_time_s)), 1.0, 2.0 * period);
  const auto warm_up = static_cast<Eigen::Index>(samples);
  const bool stores = std::any_of(extension.begin(), extension.end(), [](const AddedEffect& a) { return a.effect->stores(); });
  return stores ? run(Circuit(t_circuit(parameters), extension), t, voltage, warm_up)
                : run(Modes(modes, extension), t, voltage, warm_up);
}

}  // namespace bodeflow::residual
