#include "generate/motor.hpp"

#include <cmath>

namespace battery {

Motor Motor::draw(Random& random) {
  const auto near = [&](double value) { return value * random.uniform(0.92, 1.08); };
  Motor m;
  m.rs = near(m.rs);
  m.rr = near(m.rr);
  m.leakage = near(m.leakage);
  m.lm = near(m.lm);
  m.voltage_rms = random.log_uniform(12.0, 40.0);
  return m;
}

std::vector<double> Motor::parameters() const {
  const double l = lm + leakage, sigma = l - lm * lm / l, alpha = rr / l, lm_beta = lm * lm / (l * sigma);
  return {rs / sigma + alpha * lm_beta, alpha, lm_beta, 1.0 / sigma};
}

std::vector<Mode> Motor::modes(const std::vector<double>& parameters) {
  const double gamma = parameters[0], alpha = parameters[1], lm_beta = parameters[2], gain = parameters[3];
  const double half = 0.5 * (gamma + alpha), product = alpha * (gamma - alpha * lm_beta);
  const double root = std::sqrt(half * half - product);
  const double fast = -(half + root), slow = product / fast;
  return {{fast, gain * (fast + alpha) / (fast - slow)}, {slow, gain * (slow + alpha) / (slow - fast)}};
}

std::vector<Mode> Motor::modes() const { return modes(parameters()); }

Complex Motor::admittance(Complex s, Complex rotor_factor) const {
  const Complex rotor = rr * rotor_factor + s * leakage, iron = s * lm;
  return 1.0 / (rs + s * leakage + rotor * iron / (rotor + iron));
}

std::vector<int> Motor::line_choice() const {
  std::vector<int> lines;
  double next = 1.0;
  for (int line = 1; line < 410; line += 2) {
    if (line < next) continue;
    lines.push_back(line);
    next = line < 40 ? line + 2.0 : line * 1.07;
  }
  return lines;
}

Series held_response(const std::vector<Mode>& modes, const Drive& d, double delay) {
  const double whole = std::floor(delay / d.sample_time), rest = delay - whole * d.sample_time;
  const auto late = static_cast<std::size_t>(whole);
  const double step = d.sample_time / static_cast<double>(kSubsteps);
  Series y(d.all_samples() * kSubsteps, 0.0);
  // The output at substep q of sample n belongs to a time `rest` earlier: in sample n, or in the one before.
  for (const Mode& m : modes) {
    const auto lag = [&](double t) { return m.residue * std::expm1(m.pole * t) / m.pole; };
    double x = 0.0, x_before = 0.0, u_before = 0.0;
    for (std::size_t n = 0; n + late < d.all_samples(); ++n) {
      const double u = d.sample(n);
      double* out = y.data() + (n + late) * kSubsteps;
      for (std::size_t q = 0; q < kSubsteps; ++q) {
        const double t = static_cast<double>(q) * step - rest;
        out[q] += t >= 0.0 ? std::exp(m.pole * t) * x + lag(t) * u
                           : std::exp(m.pole * (t + d.sample_time)) * x_before + lag(t + d.sample_time) * u_before;
      }
      x_before = x;
      u_before = u;
      x = std::exp(m.pole * d.sample_time) * x + lag(d.sample_time) * u;
    }
  }
  return y;
}

Series Motor::clean(const Drive& d) const { return held_response(modes(), d, 0.0); }

Complex Motor::response(const std::vector<double>& parameters, double omega) const {
  const double t = sample_time();
  const Complex back = std::polar(1.0, -omega * t);
  Complex sum;
  for (const Mode& m : modes(parameters)) {
    sum += m.residue * std::expm1(m.pole * t) / m.pole * back / (1.0 - std::exp(m.pole * t) * back);
  }
  return sum;
}

}  // namespace battery
