#include <cmath>

#include "catch.hpp"
#include "drive/motor.hpp"
#include "drive/pwm.hpp"
#include "plugins/loaded_block.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

const Rate kRate{10000, 1};

/// A motor of Table 1.
template <class Driver>
Driver& with_parameters(Driver& block) {
  block.set("rs", 6.6).set("rr", 5.5).set("ls", 0.475).set("lr", 0.475).set("lm", 0.454);
  return block;
}

/// Legs of n periods of a turning vector of 150 V, seven channels.
Channels turning_legs(int n) {
  Channels legs(7);
  drive::Modulation modulation;
  modulation.min_max = true;
  for (int k = 0; k < n; ++k) {
    const drive::Switching s = drive::switching(modulation, {150 * std::cos(0.02 * k), 150 * std::sin(0.02 * k)}, {}, {});
    for (std::size_t leg = 0; leg < 3; ++leg) {
      legs[2 * leg].push_back(s.legs[leg].on);
      legs[2 * leg + 1].push_back(s.legs[leg].off);
    }
    legs[6].push_back(540.0);
  }
  return legs;
}

std::string motor_refusal(
    std::vector<Stream> streams, void (*prepare)(LoadedBlock&) = [](LoadedBlock&) {}) {
  LoadedBlock motor("drive.induction_motor");
  with_parameters(motor).feed(std::move(streams));
  prepare(motor);
  return refusal_of([&] { motor.start().run(3); });
}

}  // namespace

TEST_CASE("induction motor: the block gives what the algorithm gives, one sample after the legs, for any size of calls") {
  const Channels legs = turning_legs(1000);
  LoadedBlock block("drive.induction_motor");
  with_parameters(block).set("inertia", 0.004).set("pole_pairs", std::int64_t{2});
  block.feed({Stream::with(legs, kRate)}).start();
  const Channels current = block.run(1000, 256);
  auto motor = std::move(*drive::make_motor({{6.6, 5.5, 0.475, 0.475, 0.454}, {}, {2.0, 0.004, 0.0, 0.0, false}, 1e-4}));
  for (std::size_t n = 0; n < 1000; ++n) {
    REQUIRE(current[0][n] == motor->outputs().current.alpha);
    REQUIRE(current[1][n] == motor->outputs().current.beta);
    motor->advance({{{legs[0][n], legs[1][n]}, {legs[2][n], legs[3][n]}, {legs[4][n], legs[5][n]}}}, 540.0, 0.0);
  }
  for (const std::uint64_t chunk : {1, 7, 500}) {
    block.reset();
    CHECK(block.run(1000, chunk) == current);
  }
}

TEST_CASE("induction motor: streams that do not fit are refused") {
  CHECK(motor_refusal({Stream::with(Channels(3, {0, 0, 0}), kRate)}) == "'legs' has 3 channels, allowed: 5 (alpha alone) or 7");
  CHECK(motor_refusal({Stream::with({{2e-5, 2e-5, 0}, {8e-5, 8e-5, 0}, {2e-5, 9e-5, 0}, {8e-5, 8e-5, 0}, {540, 540, 540}},
                                    kRate)}) == "'legs' has instants outside the order 0 <= on <= off <= period at sample 1");
  CHECK(motor_refusal({Stream::with(Channels(7, {0, 0, 0}), kRate)}) ==
        "the motor may turn and has inertia = 0 kg m^2, allowed: positive, or standstill");
  Stream averaged = Stream::with(Channels(5, {0, 0, 0}), kRate);
  averaged.facts.notes["drive.averaged"] = {1.0};
  CHECK(motor_refusal({averaged}) ==
        "the inverter has mode: averaged; allowed: connect its output 'voltage', or take mode: switching");
}

TEST_CASE("induction motor: parameters of no form, or of two, are refused") {
  LoadedBlock block("drive.induction_motor");
  with_parameters(block).set("sigma", 0.041);
  CHECK(refusal_of([&] { block.configure(); }) ==
        "parameters of the motor: rs, rr, ls, lr, lm, sigma; allowed: rs, rr, ls, lr, lm; or rs, rr, lm, stator_leakage, "
        "rotor_leakage; or alpha, gamma, sigma with beta or lm_beta or both; or rs, rotor_resistance, leakage, magnetising");
}

TEST_CASE("induction motor: the forms of its parameters give the same current") {
  std::vector<double> u(2000);
  for (std::size_t n = 0; n < u.size(); ++n) u[n] = 10 * std::sin(1e-6 * static_cast<double>(n * n));
  Channels legs(5, std::vector<double>(u.size()));
  for (std::size_t n = 0; n < u.size(); ++n) {
    const drive::Switching s = drive::switching({}, {u[n], 0}, {}, {});
    for (std::size_t leg = 0; leg < 2; ++leg) {
      legs[2 * leg][n] = s.legs[leg].on;
      legs[2 * leg + 1][n] = s.legs[leg].off;
    }
    legs[4][n] = 540.0;
  }
  const auto current = [&](const std::vector<std::pair<const char*, double>>& parameters) {
    LoadedBlock block("drive.induction_motor");
    for (const auto& [name, value] : parameters) block.set(name, value);
    return block.feed({Stream::with(legs, kRate)}).start().run(u.size())[0].back();
  };
  const double expected = current({{"rs", 6.6}, {"rr", 5.5}, {"ls", 0.475}, {"lr", 0.475}, {"lm", 0.454}});
  CHECK(std::abs(expected) > 0.1);
  const drive::MotorParameters p{6.6, 5.5, 0.475, 0.475, 0.454};
  const drive::ModelConstants c = drive::constants_of(p);
  const drive::InverseGammaForm g = drive::inverse_gamma_form(p);
  CHECK(current({{"rs", 6.6}, {"rr", 5.5}, {"stator_leakage", 0.021}, {"rotor_leakage", 0.021}, {"lm", 0.454}}) ==
        Approx(expected).epsilon(1e-11));
  CHECK(current({{"alpha", c.alpha}, {"lm_beta", c.lm_beta}, {"gamma", c.gamma}, {"sigma", c.sigma}}) ==
        Approx(expected).epsilon(1e-11));
  CHECK(
      current({{"rs", 6.6}, {"rotor_resistance", g.rotor_resistance}, {"leakage", g.leakage}, {"magnetising", g.magnetising}}) ==
      Approx(expected).epsilon(1e-11));
}

TEST_CASE("inverter: dead time and compensation without their currents, and rates and channels that do not fit, are refused") {
  const auto refusal = [](auto prepare, std::vector<Stream> streams) {
    LoadedBlock inverter("drive.inverter");
    prepare(inverter);
    inverter.feed(std::move(streams));
    return refusal_of([&] { inverter.start().run(3); });
  };
  const Stream reference = Stream::of({0, 10, 0}, kRate);
  CHECK(refusal([](LoadedBlock& b) { b.set("dead_time", 1e-6); }, {reference}) ==
        "dead_time moves the edges by the sign of the motor's current: connect it to 'current'");
  CHECK(refusal([](LoadedBlock& b) { b.set("compensation", "sign"); }, {reference, reference}) ==
        "compensation: sign needs a current: connect a sensor, or the motor's current, to 'measured_current'");
  CHECK(refusal([](LoadedBlock& b) { b.set("pwm", 20000.0); }, {reference}) ==
        "'reference' has 10000 samples/s, pwm is 20000 Hz; allowed: one sample a PWM period (filters.hold raises the rate)");
  CHECK(refusal([](LoadedBlock& b) { b.set("dead_time", 30e-6); }, {reference, reference}) ==
        "dead_time and compensation_time: at most a fifth of the PWM period, 20 us");
  CHECK(refusal([](LoadedBlock&) {}, {reference, Stream::with(Channels(2, {0, 0, 0}), kRate)}) ==
        "'current' has 2 channels, 'reference' has 1; allowed: the same number");
  CHECK(refusal([](LoadedBlock&) {}, {Stream::of({0, std::nan(""), 0}, kRate)}) == "'reference' is not finite at sample 1");
}

TEST_CASE("inverter: compensation switches while it runs, and the computation delay holds reference and measurement back") {
  LoadedBlock inverter("drive.inverter");
  inverter.set("dead_time", 1.5e-6).set("computation_delay", std::int64_t{2});
  const Stream constant = Stream::of(std::vector<double>(30, 0.5), kRate),
               reference = Stream::of(std::vector<double>(30, 20.0), kRate);
  inverter.feed({reference, constant, constant}).start();
  const auto mean = [](const Channels& legs, std::size_t n) {
    return 2.0 / 3.0 * 540.0 * ((legs[1][n] - legs[0][n]) - (legs[3][n] - legs[2][n])) / 1e-4;
  };
  const Channels before = inverter.run(10);
  CHECK(mean(before, 1) == Approx(-10.8));
  CHECK(mean(before, 2) == Approx(20.0 - 10.8));
  inverter.change("compensation", "sign");
  CHECK(mean(inverter.run(10), 0) == Approx(20.0));
  inverter.change("compensation", "none");
  CHECK(mean(inverter.run(10), 0) == Approx(20.0 - 10.8));
}
