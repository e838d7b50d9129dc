#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <string>

#include "catch.hpp"
#include "drive/motor.hpp"

using namespace bodeflow::drive;
using Complex = std::complex<double>;

namespace {

constexpr MotorParameters kPaper{6.6, 5.5, 0.475, 0.475, 0.454};
constexpr double kVacuum = 4e-7 * M_PI;

HiddenPhysics hidden(double isat, double bar_height, double iron) {
  HiddenPhysics h;
  h.saturation_current = isat;
  h.bar_height = bar_height;
  h.iron_loss_resistance = iron;
  return h;
}

std::unique_ptr<Motor> motor_of(const HiddenPhysics& h, const Mechanics& mechanics, double period_s) {
  auto made = make_motor({kPaper, h, mechanics, period_s});
  REQUIRE(made);
  return std::move(*made);
}

/// Impedance of the network as its matrices say.
Complex impedance(const MotorNetwork& network, double omega) {
  const Eigen::MatrixXcd z =
      Complex(0, omega) * network.inductance.cast<Complex>() + Eigen::MatrixXcd(network.resistance.cast<Complex>().asDiagonal());
  return 1.0 / Eigen::MatrixXcd(z.inverse())(0, 0);
}

/// Resistance and leakage of the rotor that the network must have: a bar of rectangular section in its slot.
Complex rotor_with_bars(const HiddenPhysics& h, double omega) {
  const double bar = h.bar_share * kPaper.rr, tau = kVacuum * h.bar_conductivity * h.bar_height * h.bar_height;
  const Complex s(0, omega), z = std::sqrt(s * tau);
  return kPaper.rr - bar + s * (kPaper.lr - bar * tau / 3.0) + bar * z / std::tanh(z);
}

/// Energy in the inductances of both axes, 3/2 as the power of amplitude-invariant vectors.
double stored(const MotorNetwork& network, const HiddenPhysics& h, const LoopCurrents& x) {
  const LoopMatrix leakage = saturated_inductance(network, 0.0);
  const double length = (x * network.magnetises).norm(), isat = h.saturation_current;
  double energy = 0.5 * (x * leakage * x.transpose()).trace();
  if (isat == 0.0) return 1.5 * (energy + 0.5 * kPaper.lm * length * length);
  const double psi = kPaper.lm * (0.25 * length + 0.75 * isat * std::tanh(length / isat));
  const double below = kPaper.lm * (0.125 * length * length + 0.75 * isat * isat * std::log(std::cosh(length / isat)));
  return 1.5 * (energy + psi * length - below);
}

struct Powers {
  double electrical, heat, mechanical;
};

Powers powers(const Motor& motor, const MotorNetwork& network, AlphaBeta v) {
  const MotorOutputs y = motor.outputs();
  const LoopCurrents x = motor.state().currents;
  return {1.5 * (v.alpha * y.current.alpha + v.beta * y.current.beta),
          1.5 * (x * network.resistance.asDiagonal() * x.transpose()).trace(), y.torque * y.speed};
}

}  // namespace

TEST_CASE("motor: what goes in is heat, field energy and work, with any hidden physics") {
  constexpr double kStep = 4e-6;
  for (const HiddenPhysics& h :
       {hidden(0, 0, 0), hidden(1.2, 0, 0), hidden(0, 0.01, 0), hidden(0, 0, 900), hidden(1.2, 0.01, 900)}) {
    const MotorNetwork network = *motor_network(kPaper, h);
    const auto motor = motor_of(h, {2.0, 0.003, 1e-3, 0.0, false}, kStep);
    Powers sum{};
    for (int n = 0; n < 25000; ++n) {
      const double angle = 2 * M_PI * 50 * n * kStep;
      const AlphaBeta v{300 * std::cos(angle), 300 * std::sin(angle)};
      const Powers before = powers(*motor, network, v);
      motor->advance(v, 1.0);
      const Powers after = powers(*motor, network, v);
      sum.electrical += 0.5 * kStep * (before.electrical + after.electrical);
      sum.heat += 0.5 * kStep * (before.heat + after.heat);
      sum.mechanical += 0.5 * kStep * (before.mechanical + after.mechanical);
    }
    const double field = stored(network, h, motor->state().currents);
    INFO("isat " << h.saturation_current << ", bars " << h.bar_height << ", iron " << h.iron_loss_resistance << ": in "
                 << sum.electrical << " J, heat " << sum.heat << " J, work " << sum.mechanical << " J, field " << field << " J");
    CHECK(sum.mechanical > 1.0);
    CHECK(std::abs(sum.electrical - sum.heat - sum.mechanical - field) < 2e-5 * sum.electrical);
  }
}

TEST_CASE("motor: torque at steady slip is that of the equivalent circuit") {
  constexpr double kStep = 2e-5, kOmega = 2 * M_PI * 50, kVolts = 310.0, kPairs = 2.0;
  constexpr double kStairs = 1e-5;  // what the steps of the supply add; a fourth of it with half the step
  for (const double iron : {0.0, 600.0}) {
    for (const double slip : {0.02, 0.1, 1.0, -0.05}) {
      const auto motor = motor_of(hidden(0, 0, iron), {kPairs, 1e9, 0.0, (1 - slip) * kOmega / kPairs, false}, kStep);
      const Complex rotor = kPaper.rr / slip + Complex(0, kOmega * (kPaper.lr - kPaper.lm));
      Complex branch = Complex(0, kOmega * kPaper.lm);
      if (iron > 0) branch = 1.0 / (1.0 / branch + 1.0 / iron);
      const Complex gap = 1.0 / (1.0 / branch + 1.0 / rotor);
      const Complex stator = kVolts / (kPaper.rs + Complex(0, kOmega * (kPaper.ls - kPaper.lm)) + gap);
      const double expected = 1.5 * std::norm(stator * gap / rotor) * kPaper.rr / slip * kPairs / kOmega;
      const double hold = std::sin(0.5 * kOmega * kStep) / (0.5 * kOmega * kStep);  // of the staircase
      double mean = 0.0;
      constexpr int kSettling = 100000, kCycle = 1000;
      for (int n = 0; n < kSettling + kCycle; ++n) {
        const double angle = kOmega * n * kStep;
        motor->advance({kVolts / hold * std::cos(angle), kVolts / hold * std::sin(angle)}, 0.0);
        if (n >= kSettling) mean += motor->outputs().torque / kCycle;
      }
      INFO("slip " << slip << ", iron " << iron);
      CHECK(mean == Approx(expected).epsilon(kStairs));
    }
  }
}

TEST_CASE("motor: the ladder of a rotor bar is the diffusion of the field, R z coth z, within 1e-5 up to 100 Hz") {
  for (const double height : {0.015, 0.02, 0.03}) {
    const HiddenPhysics h = hidden(0, height, 0);
    const MotorNetwork network = *motor_network(kPaper, h);
    for (const double hertz : {0.1, 1.0, 5.0, 20.0, 50.0, 100.0}) {
      const double omega = 2 * M_PI * hertz;
      const Complex s(0, omega);
      const Complex expected = kPaper.rs + s * kPaper.ls - s * kPaper.lm * s * kPaper.lm / rotor_with_bars(h, omega);
      INFO(height << " m, " << hertz << " Hz");
      CHECK(std::abs(impedance(network, omega) - expected) < 1e-5 * std::abs(expected));
    }
  }
  const double published[][2] = {{0.015, 1.07}, {0.02, 1.21}, {0.03, 1.67}};  // Rac/Rdc at 50 Hz
  for (const auto& [height, ratio] : published) {
    CHECK(rotor_with_bars(hidden(0, height, 0), 100 * M_PI).real() / kPaper.rr == Approx(ratio).margin(0.006));
  }
}

TEST_CASE("motor: at 0 Hz hidden bars and iron loss change neither resistance nor inductance of the rotor") {
  const MotorNetwork plain = *motor_network(kPaper, {}), real = *motor_network(kPaper, hidden(0, 0.01, 2000));
  const double omega = 1e-3;
  CHECK(std::abs(impedance(plain, omega) - impedance(real, omega)) < 1e-6 * std::abs(impedance(plain, omega)));
}

TEST_CASE("motor: Runge-Kutta steps between the edges of a switching inverter agree with the exact solution") {
  const double cases[][3] = {{0, 0, 1e-10}, {0.012, 0, 2e-7}, {0, 800, 2e-7}, {0.012, 800, 2e-7}};  // bars, iron, error
  for (const auto& [bars, iron, allowed] : cases) {
    const auto exact = motor_of(hidden(0, bars, iron), {}, 1e-4);
    const auto stepped = motor_of(hidden(1e7, bars, iron), {}, 1e-4);  // a curve that does not bend
    double worst = 0.0, largest = 0.0;
    for (int n = 0; n < 5000; ++n) {
      const Switching s = switching({}, {120 * std::cos(0.03 * n), 120 * std::sin(0.02 * n)}, {}, {});
      exact->advance(s.legs, 540.0, 0.0);
      stepped->advance(s.legs, 540.0, 0.0);
      const AlphaBeta a = exact->outputs().current, b = stepped->outputs().current;
      worst = std::max(worst, std::hypot(a.alpha - b.alpha, a.beta - b.beta));
      largest = std::max(largest, std::hypot(a.alpha, a.beta));
    }
    INFO("bars " << bars << " m, iron " << iron << " ohm: " << worst << " of " << largest);
    CHECK(worst < allowed * largest);
  }
}

TEST_CASE("motor: a direct current magnetises along the saturation law, in any direction") {
  const double isat = 1.2, current = 3.0;
  const auto motor = motor_of(hidden(isat, 0, 0), {}, 1e-4);
  for (int n = 0; n < 60000; ++n) motor->advance({current * kPaper.rs * 0.6, current * kPaper.rs * 0.8}, 0.0);
  const MotorOutputs y = motor->outputs();
  const double psi = kPaper.lm * (0.25 * current + 0.75 * isat * std::tanh(current / isat));
  CHECK(y.current.alpha == Approx(0.6 * current).epsilon(1e-9));
  CHECK(y.flux.alpha == Approx(0.6 * psi).epsilon(1e-9));
  CHECK(y.flux.beta == Approx(0.8 * psi).epsilon(1e-9));
  CHECK(y.torque == Approx(0.0).margin(1e-12));
}

TEST_CASE("motor: a saturating motor keeps its currents when its state is handed over") {
  for (const HiddenPhysics& h : {hidden(1.2, 0, 0), hidden(1.2, 0.01, 900)}) {
    const auto first = motor_of(h, {2.0, 0.003, 0.0, 0.0, false}, 1e-4),
               second = motor_of(h, {2.0, 0.003, 0.0, 0.0, false}, 1e-4);
    for (int n = 0; n < 500; ++n) first->advance({200 * std::cos(0.0314 * n), 200 * std::sin(0.0314 * n)}, 0.0);
    second->set_state(first->state());
    CHECK((second->state().currents - first->state().currents).norm() < 1e-10 * first->state().currents.norm());
    CHECK(second->outputs().torque == Approx(first->outputs().torque).epsilon(1e-9));
  }
}

TEST_CASE("motor: what cannot be built is refused by name") {
  const auto refusal = [](const MotorSetup& setup) { return make_motor(setup).error().text; };
  MotorSetup setup{kPaper, {}, {}, 1e-4};
  setup.mechanics.locked = false;
  CHECK(refusal(setup) == "the motor may turn and has inertia = 0 kg m^2, allowed: positive, or standstill");
  setup.mechanics.locked = true;
  setup.hidden.bar_height = 0.05;
  CHECK(refusal(setup) == "bar_height = 0.05 m: slots of that height have more leakage than the 0.0410716 H of the whole motor");
  setup.hidden.bar_height = 0.03;
  setup.hidden.saturation_current = 1.0;
  CHECK(refusal(setup) ==
        "saturation of the magnetising branch needs leakage on both sides; found 0.021 H on the stator's and 0.021 H on the "
        "rotor's, slots of the bars included");
  setup = {*from_inverse_gamma(inverse_gamma_form(kPaper)), hidden(0, 0, 500), {}, 1e-4};
  CHECK(refusal(setup) ==
        "iron loss needs leakage on both sides: ls = 0.475 H and lr = 0.433928 H, allowed: above lm = 0.433928 H");
}
