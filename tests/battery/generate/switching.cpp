#include "generate/switching.hpp"

#include <algorithm>
#include <cmath>

namespace battery {
namespace {

/// The motor's current as the sum of two modes.
class Current {
 public:
  explicit Current(const std::vector<Mode>& modes) : modes_(modes), x_(modes.size(), 0.0) {}

  double value() const {
    double sum = 0.0;
    for (const double x : x_) sum += x;
    return sum;
  }
  void go(double voltage, double time) {
    for (std::size_t n = 0; n < modes_.size(); ++n) {
      const double e = std::expm1(modes_[n].pole * time);
      x_[n] += e * (x_[n] + modes_[n].residue / modes_[n].pole * voltage);
    }
  }

 private:
  std::vector<Mode> modes_;
  Series x_;
};

/// An edge at which the leg goes from one voltage to the other: at once, or after the dead time where a diode holds it, as
/// long as the current keeps its direction. Gives the time that passed beyond the edge.
double pass_edge(Current& i, double from, double dead_time, bool rising) {
  const auto held = [&] { return rising ? i.value() > 0.0 : i.value() < 0.0; };
  if (dead_time <= 0.0 || !held()) return 0.0;
  Current trial = i;
  trial.go(from, dead_time);
  const bool stays = rising ? trial.value() > 0.0 : trial.value() < 0.0;
  if (stays) {
    i = trial;
    return dead_time;
  }
  // The current reaches zero within the dead time: the diode opens and the leg follows.
  double low = 0.0, high = dead_time;
  for (int n = 0; n < 40; ++n) {
    const double middle = 0.5 * (low + high);
    trial = i;
    trial.go(from, middle);
    ((rising ? trial.value() > 0.0 : trial.value() < 0.0) ? low : high) = middle;
  }
  i.go(from, low);
  return low;
}

}  // namespace

Series switched_current(const Motor& motor, const Switching& s, const Drive& d) {
  Current i(motor.modes());
  const double period = d.sample_time / static_cast<double>(s.periods_per_sample), up = 0.5 * s.link;
  Series y(d.samples());
  const std::size_t settling = kSettling * d.period;
  for (std::size_t n = 0; n < d.all_samples(); ++n) {
    if (n >= settling) y[n - settling] = i.value();
    const double duty = std::clamp(0.5 + d.sample(n) / s.link, 0.0, 1.0);
    const double rise = 0.5 * (1.0 - duty) * period, pulse = duty * period;
    for (std::size_t p = 0; p < s.periods_per_sample; ++p) {
      i.go(-up, rise);
      const double rises_late = pass_edge(i, -up, s.dead_time, true);
      i.go(up, std::max(pulse - rises_late, 0.0));
      const double falls_late = pass_edge(i, up, s.dead_time, false);
      i.go(-up, period - rise - std::max(pulse, rises_late) - falls_late);
    }
  }
  return y;
}

}  // namespace battery
