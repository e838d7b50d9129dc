#include "simple_bench.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <numbers>

namespace bodeflow::residual::bench {
namespace {

constexpr std::int64_t kPeriod = 4096;
constexpr int kSteps = 20;  // of a sample

class Motor {
 public:
  explicit Motor(const SimpleBench& b) : b_(b) {}

  void step(double voltage, double h) {
    const auto [ds, dr] = slope(stator_, rotor_, voltage);
    const auto [es, er] = slope(stator_ + h * ds, rotor_ + h * dr, voltage);
    stator_ += 0.5 * h * (ds + es);
    rotor_ += 0.5 * h * (dr + er);
  }
  double current() { return stator_current(stator_, rotor_); }

 private:
  double main_flux(double i) const {
    if (b_.saturation_current == 0.0) return b_.lm * i;
    return b_.lm * (0.25 * i + 0.75 * b_.saturation_current * std::tanh(i / b_.saturation_current));
  }
  double main_slope(double i) const {
    if (b_.saturation_current == 0.0) return b_.lm;
    const double t = std::tanh(i / b_.saturation_current);
    return b_.lm * (0.25 + 0.75 * (1.0 - t * t));
  }
  /// (stator - psi(i)) / ls' + (rotor - psi(i)) / lr' = i by Newton's method.
  double stator_current(double stator, double rotor) {
    const double s = b_.ls - b_.lm, r = b_.lr - b_.lm;
    for (int n = 0; n < 3; ++n) {
      const double psi = main_flux(magnetising_);
      const double error = (stator - psi) / s + (rotor - psi) / r - magnetising_;
      const double change = error / (main_slope(magnetising_) * (1.0 / s + 1.0 / r) + 1.0);
      magnetising_ += change;
      if (std::abs(change) < 1e-12) break;
    }
    return (stator - main_flux(magnetising_)) / s;
  }
  std::pair<double, double> slope(double stator, double rotor, double voltage) {
    const double i = stator_current(stator, rotor);
    const double lost = i > 0.0 ? b_.dead_time_voltage : i < 0.0 ? -b_.dead_time_voltage : 0.0;
    return {voltage - (std::abs(i) < 0.02 ? lost * std::abs(i) / 0.02 : lost) - b_.rs * i, -b_.rr * (magnetising_ - i)};
  }

  SimpleBench b_;
  double stator_ = 0.0, rotor_ = 0.0, magnetising_ = 0.0;
};

Eigen::VectorXd multisine(double amplitude, numerics::Random& random) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(kPeriod);
  for (const std::int64_t k : test_lines()) {
    const double phase = 2.0 * std::numbers::pi * random.uniform();
    for (std::int64_t n = 0; n < kPeriod; ++n)
      u[n] += amplitude *
              std::cos(2.0 * std::numbers::pi * static_cast<double>(k * n % kPeriod) / static_cast<double>(kPeriod) + phase);
  }
  return u;
}

}  // namespace

std::vector<std::int64_t> test_lines() {
  std::vector<std::int64_t> lines;
  for (double k = 1.0; k < 820.0; k *= 1.105) {
    const auto odd = 2 * static_cast<std::int64_t>(k / 2.0) + 1;
    if (lines.empty() || odd > lines.back()) lines.push_back(odd);
  }
  return lines;
}

records::Recording record(const SimpleBench& bench, double amplitude, std::uint64_t seed, std::int64_t periods) {
  numerics::Random random(seed);
  const Eigen::VectorXd u = multisine(amplitude, random);
  Motor motor(bench);
  const double h = bench.sample_time_s / kSteps;
  const auto late = static_cast<std::int64_t>(std::lround((bench.computation_delay_s + bench.delay_s) / h));
  records::Recording r;
  r.sample_rate_hz = 1.0 / bench.sample_time_s;
  r.period = kPeriod;
  r.skip = 1;
  r.periods = periods;
  r.input_signals = {{"command"}, {"V"}};
  r.output_signals = {{"current"}, {"A"}};
  const std::int64_t samples = (periods + 1) * kPeriod;
  r.input.resize(samples, 1);
  r.output.resize(samples, 1);
  for (std::int64_t n = 0; n < samples; ++n) {
    r.input(n, 0) = u[n % kPeriod];
    r.output(n, 0) = motor.current() + bench.noise_std * random.normal();
    for (int s = 0; s < kSteps; ++s) {
      const std::int64_t at = n * kSteps + s - late;
      motor.step(at < 0 ? 0.0 : u[at / kSteps % kPeriod], h);
    }
  }
  return r;
}

}  // namespace bodeflow::residual::bench
