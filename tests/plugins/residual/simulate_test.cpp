#include "model/simulate.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/fft.hpp>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "small_models.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;
using small::made;
using Complex = std::complex<double>;

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr Eigen::Index kPeriod = 500;
constexpr double kSample = 1.0 / 90.0;  // the resonance lies at 0.11 of the sample rate

std::shared_ptr<small::Mass> mass(Hold hold) {
  auto m = std::make_shared<small::Mass>();
  m->declared.hold = hold;
  return m;
}

Eigen::VectorXd mass_values() {
  const double omega = kTwoPi * 9.9;
  return Eigen::Vector3d(2.0, 2.0 * 2.0 * 0.05 * omega, 2.0 * omega * omega);
}

Eigen::VectorXd with(const Eigen::VectorXd& values, std::vector<double> more) {
  Eigen::VectorXd all(values.size() + static_cast<Eigen::Index>(more.size()));
  all << values, Eigen::Map<const Eigen::VectorXd>(more.data(), static_cast<Eigen::Index>(more.size()));
  return all;
}

double force(double t) {
  double sum = 0.0;
  for (int k = 5; k < 120; k += 2) sum += 40.0 * std::cos(kTwoPi * k * t / (kPeriod * kSample) + 0.37 * k * k);
  return sum;
}

Eigen::MatrixXd forces() {
  Eigen::MatrixXd u(kPeriod, 1);
  for (Eigen::Index n = 0; n < kPeriod; ++n) u(n, 0) = force(static_cast<double>(n) * kSample);
  return u;
}

Drive drive(Hold hold, int values = 1) {
  Drive d;
  d.sample_time_s = kSample;
  d.periodic = true;
  d.hold = hold;
  d.values_per_sample = values;
  d.input = values > 1 ? refined(forces(), values) : forces();
  return d;
}

Eigen::VectorXcd lines(const Eigen::VectorXd& y) { return numerics::half_dft(y) / static_cast<double>(y.size()); }

/// One steady period behind a zero-order hold by classical Runge-Kutta steps.
template <class Law>
Eigen::VectorXd reference(const Eigen::VectorXd& v, Law law, int steps) {
  Eigen::VectorXd y(kPeriod);
  double x = 0.0, s = 0.0;
  const double h = kSample / steps;
  for (Eigen::Index n = -3 * kPeriod; n < kPeriod; ++n) {
    if (n >= 0) y[n] = x;
    const double u = force(static_cast<double>((n + 3 * kPeriod) % kPeriod) * kSample);
    const auto slope = [&](double position, double speed) {
      return (u - v[1] * speed - v[2] * position - law(position, speed)) / v[0];
    };
    for (int i = 0; i < steps; ++i) {
      const double k1 = s, l1 = slope(x, s), k2 = s + h / 2 * l1, l2 = slope(x + h / 2 * k1, k2);
      const double k3 = s + h / 2 * l2, l3 = slope(x + h / 2 * k2, k3), k4 = s + h * l3, l4 = slope(x + h * k3, k4);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      s += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
    }
  }
  return y;
}

}  // namespace

TEST_CASE("simulate: a linear plant gives what its response says, whatever hold and delay") {
  const Eigen::VectorXcd in = lines(forces().col(0));
  for (const Hold hold : {Hold::zero_order, Hold::first_order}) {
    for (const double delay : {0.0, 0.3 * kSample, 2.0 * kSample, -1.4 * kSample}) {
      for (const double through : {0.0, 1e-4}) {
        auto base = mass(hold);
        base->through = through;
        base->declared.delay_s = delay;
        const JointModel model{base, {}};
        Drive d = drive(hold);
        d.delay_s = delay;
        const Eigen::VectorXcd out = lines(simulate(model, mass_values(), {}, d).value().output);
        for (const int k : {5, 41, 55, 119}) {
          const Complex g = sampled_response(model, mass_values(), {}, k / (kPeriod * kSample), kSample)[0];
          CHECK(std::abs(out[k] - g * in[k]) < 1e-9 * std::abs(g * in[k]));
        }
      }
    }
  }
}

TEST_CASE("simulate: refined values of a band-limited input give the continuous response") {
  const JointModel model{mass(Hold::band_limited), {}};
  const Eigen::VectorXcd in = lines(forces().col(0)),
                         out = lines(simulate(model, mass_values(), {}, drive(Hold::first_order, 4)).value().output);
  for (const int k : {5, 41, 55, 119}) {
    const Complex g = joint_response(model, mass_values(), {}, Complex(0.0, kTwoPi * k / (kPeriod * kSample)))[0];
    CHECK(std::abs(out[k] - g * in[k]) < 2e-4 * std::abs(g * in[k]));
  }
}

TEST_CASE("simulate: smooth laws agree with a fine reference, and better with more steps") {
  const Eigen::VectorXd v = mass_values();
  const double cubic = 0.3 * v[2] / (0.1 * 0.1);
  auto [addition, effect] = made(Acts::law, 1, 1);
  effect->law = [](const double* p, const Signals& s, const double*, double*) {
    return Reaction{p[0] * s.stored * s.stored * s.stored, 0.0, 3.0 * p[0] * s.stored * s.stored};
  };
  const Eigen::VectorXd wanted = reference(
      v, [&](double x, double) { return cubic * x * x * x; }, 40);
  double before = 1.0;
  for (const int steps : {4, 8}) {
    addition.what.steps_per_sample = steps;
    const JointModel model{mass(Hold::zero_order), {addition}};
    const Drive d = drive(Hold::zero_order);
    const Eigen::VectorXd y = simulate(model, with(v, {cubic}), {}, d).value().output,
                          linear = simulate(model, with(v, {0.0}), {}, d).value().output;
    CHECK((wanted - linear).norm() > 0.2 * linear.norm());
    const double error = (y - wanted).norm() / (wanted - linear).norm();
    CHECK(error < 3e-4);
    CHECK(error < before / 10.0);
    before = error;
  }
}

TEST_CASE("simulate: sharp friction stops a mass and lets it go, within 1 % of a fine reference") {
  const Eigen::VectorXd v = mass_values();
  auto [addition, effect] = made(Acts::law, 1, 0);
  addition.what.rough = true;
  addition.what.steps_per_sample = 4;
  effect->law = [](const double* p, const Signals& s, const double*, double*) {
    const double width = 1e-4 + s.gain * p[0];
    return std::abs(s.flow) < width ? Reaction{p[0] * s.flow / width, p[0] / width, 0.0}
                                    : Reaction{std::copysign(p[0], s.flow), 0.0, 0.0};
  };
  for (const double friction : {60.0, 300.0}) {
    JointModel model{mass(Hold::zero_order), {addition}};
    const Eigen::VectorXd y = simulate(model, with(v, {friction}), {}, drive(Hold::zero_order)).value().output,
                          linear = simulate(model, with(v, {0.0}), {}, drive(Hold::zero_order)).value().output;
    model.additions[0].what.steps_per_sample = 64;
    const Eigen::VectorXd fine = simulate(model, with(v, {friction}), {}, drive(Hold::zero_order)).value().output;
    CHECK((y - fine).norm() < 0.01 * (fine - linear).norm());
    // An independent look at the fine one: friction as a steep smooth law, small explicit steps.
    const Eigen::VectorXd other = reference(
        v, [&](double, double s) { return friction * std::tanh(s / 0.01); }, 100);
    CHECK((fine - other).norm() < 0.02 * (fine - linear).norm());
  }
}

TEST_CASE("simulate: a law keeps its memory from step to step") {
  // A spring behind a play of half width b: the exact play operator on the position, which does not load the mass much.
  const Eigen::VectorXd v = mass_values();
  auto [addition, effect] = made(Acts::law, 2, 1);
  addition.what.memory = 1;
  effect->law = [](const double* p, const Signals& s, const double* memory, double* next) {
    next[0] = std::clamp(memory[0], s.stored - p[1], s.stored + p[1]);
    return Reaction{p[0] * (s.stored - next[0]), 0.0, next[0] == memory[0] ? p[0] : 0.0};
  };
  const JointModel model{mass(Hold::zero_order), {addition}};
  const auto at = [&](double stiffness, int steps) {
    JointModel m = model;
    m.additions[0].what.steps_per_sample = steps;
    return simulate(m, with(v, {stiffness, 0.02}), {}, drive(Hold::zero_order)).value().output;
  };
  const Eigen::VectorXd linear = at(0.0, 4), fine = at(0.5 * v[2], 128), y = at(0.5 * v[2], 8);
  CHECK((fine - linear).norm() > 0.1 * linear.norm());
  CHECK((y - fine).norm() < 0.01 * (fine - linear).norm());
}

TEST_CASE("simulate: laws that are linear act as the closed form says, at two places at once") {
  const Eigen::VectorXd v = mass_values();
  auto [bearing, damper] = made(Acts::law, 1, 0);
  auto [spring, stiffener] = made(Acts::law, 1, 1);
  damper->law = [](const double* p, const Signals& s, const double*, double*) { return Reaction{p[0] * s.flow, p[0], 0.0}; };
  stiffener->law = [](const double* p, const Signals& s, const double*, double*) { return Reaction{p[0] * s.stored, 0.0, p[0]}; };
  const JointModel model{mass(Hold::zero_order), {bearing, spring}}, plain{mass(Hold::zero_order), {}};
  const Eigen::VectorXd y = simulate(model, with(v, {v[1], 0.3 * v[2]}), {}, drive(Hold::zero_order)).value().output;
  const Eigen::Vector3d other(v[0], 2.0 * v[1], 1.3 * v[2]);
  const Eigen::VectorXd wanted = simulate(plain, other, {}, drive(Hold::zero_order)).value().output;
  CHECK((y - wanted).norm() < 1e-3 * wanted.norm());
}

TEST_CASE("simulate: once through, from a given state, with a late sample") {
  const JointModel model{mass(Hold::zero_order), {}};
  Drive d = drive(Hold::zero_order);
  d.periodic = false;
  d.input.setZero();
  d.initial = Eigen::Vector2d(1.0, 0.0);
  d.delay_s = 0.25 * kSample;
  const Simulated s = simulate(model, mass_values(), {}, d).value();
  const double omega = kTwoPi * 9.9, damped = omega * std::sqrt(1.0 - 0.05 * 0.05), t = 9.75 * kSample;
  CHECK(s.output[10] ==
        Approx(std::exp(-0.05 * omega * t) * (std::cos(damped * t) + 0.05 * omega / damped * std::sin(damped * t))));
  CHECK(s.stored(10, 1) == s.output[10]);
}

TEST_CASE("simulate: a plant that integrates keeps its steady form and loses its drift") {
  const JointModel model{mass(Hold::zero_order), {}};
  Drive d = drive(Hold::zero_order);
  d.input.array() += 0.5;
  const Eigen::VectorXcd in = lines(forces().col(0)),
                         out = lines(simulate(model, Eigen::Vector3d(2.0, 30.0, 1e-12), {}, d).value().output);
  const Complex g = sampled_response(model, Eigen::Vector3d(2.0, 30.0, 1e-12), {}, 41 / (kPeriod * kSample), kSample)[0];
  CHECK(std::abs(out[41] - g * in[41]) < 1e-6 * std::abs(g * in[41]));
}

TEST_CASE("simulate: parameters outside of the domain and drives that do not fit are told") {
  const JointModel model{mass(Hold::zero_order), {}};
  CHECK_FALSE(simulate(model, Eigen::Vector3d(-1.0, 1.0, 1.0), {}, drive(Hold::zero_order)).value().output.allFinite());
  Drive d = drive(Hold::zero_order);
  d.input.resize(kPeriod, 2);
  d.input.setZero();
  CHECK(simulate(model, mass_values(), {}, d).error().text == "the plant has 1 input(s), the drive has 2");
}

TEST_CASE("responses: an immittance at a place, a series and a parallel effect") {
  const Eigen::VectorXd v = mass_values();
  auto [bearing, impedance] = made(Acts::immittance, 1, 0);
  impedance->passes = [](const double* p, Complex) { return Complex(p[0]); };
  auto [lag, lowpass] = made(Acts::series, 1);
  lowpass->passes = [](const double* p, Complex s) { return 1.0 / (1.0 + s * p[0]); };
  auto [mode, beside] = made(Acts::parallel, 1);
  beside->passes = [](const double* p, Complex s) { return p[0] / (s * s + 10.0 * s + 1e5); };
  const JointModel model{mass(Hold::band_limited), {bearing, lag, mode}};
  const Complex s(0.0, 50.0);
  const Complex wanted = (1.0 / (v[0] * s * s + (v[1] + 7.0) * s + v[2]) + 3.0 / (s * s + 10.0 * s + 1e5)) / (1.0 + 0.01 * s);
  CHECK(std::abs(joint_response(model, with(v, {7.0, 0.01, 3.0}), {}, s)[0] - wanted) < 1e-12 * std::abs(wanted));
}

TEST_CASE("responses: behind a hold, a lag at the sensor is as good as a plant with one more state") {
  struct Lagging final : BaseModel {
    std::vector<FitParameter> parameters() const override { return {positive("t", "s")}; }
    Timing timing() const override { return {Hold::zero_order, 0.0}; }
    std::vector<std::vector<double>> starts(std::span<const MeasuredResponse>) const override { return {{1.0}}; }
    bool state_space(const double* v, const double*, LinearPlant& p) const override {
      const Eigen::VectorXd m = mass_values();
      p.resize(3, 1, 0);
      p.A = {0.0, 1.0, 0.0, -m[2] / m[0], -m[1] / m[0], 0.0, 1.0 / v[0], 0.0, -1.0 / v[0]};
      p.B = {0.0, 1.0 / m[0], 0.0};
      p.C = {0.0, 0.0, 1.0};
      return true;
    }
  };
  auto [lag, lowpass] = made(Acts::series, 1);
  lowpass->passes = [](const double* p, Complex s) { return 1.0 / (1.0 + s * p[0]); };
  const JointModel model{mass(Hold::zero_order), {lag}}, exact{std::make_shared<Lagging>(), {}};
  for (const double f : {1.0, 9.9, 20.0, 36.0}) {
    const Complex a = sampled_response(model, with(mass_values(), {0.004}), {}, f, kSample)[0];
    const Complex b = sampled_response(exact, Eigen::VectorXd::Constant(1, 0.004), {}, f, kSample)[0];
    CHECK(std::abs(a - b) < 2e-4 * std::abs(b));
  }
}

TEST_CASE("responses: the slowest time constant, infinite for a plant that integrates") {
  const JointModel model{mass(Hold::zero_order), {}};
  CHECK(settling_s(model, mass_values(), {}) == Approx(1.0 / (0.05 * kTwoPi * 9.9)));
  CHECK(std::isinf(settling_s(model, Eigen::Vector3d(1.0, 1.0, 0.0), {})));
}
