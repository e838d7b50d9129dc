#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "drive/classical_tests_block.hpp"
#include "drive/power_meter_block.hpp"
#include "drive/supply_block.hpp"
#include "plugins/block_driver.hpp"
#include "records/model.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;
using test::BlockDriver;
using test::Channels;
using test::failure_of;
using Complex = std::complex<double>;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRate = 10e3;
// Castaldi, Montanari, Tilli 2002, Table 1.
constexpr MotorParameters kTable1{6.6, 5.5, 0.475, 0.475, 0.454};

StreamFacts stream(int channels, double rate = kRate) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate::from_hz(rate);
  return f;
}

/// The record that a meter makes of these samples.
RecordBuilder measurement(double frequency, Complex impedance, double current = 1.0) {
  RecordBuilder r("power_measurement");
  return r.set("frequency", frequency)
      .set("current", current)
      .set("resistance", impedance.real())
      .set("reactance", impedance.imag());
}

/// The meter after a whole run.
void measure(BlockDriver<PowerMeter>& meter, const Channels& u, const Channels& i) {
  meter.configure();
  meter.resolve({stream(static_cast<int>(u.size())), stream(static_cast<int>(i.size()))});
  meter.activate(u[0].size(), Rate::from_hz(kRate));
  meter.process({u, i}, u[0].size());
  meter.finish();
}

/// Receives at a port that is not the first.
void give(ClassicalTests& tests, MessageIn port, const RecordBuilder& record) {
  std::vector<std::uint8_t> bytes = record.bytes();
  bf_process process{};
  const bf_host host{};
  Io io(process, host);
  tests.receive(port.index, RecordView(bytes.data()), io);
}

}  // namespace

TEST_CASE("classical tests: the impedances of a motor give back the motor") {
  for (const MotorParameters& truth : {kTable1, MotorParameters{0.4, 0.25, 0.031, 0.031, 0.0297}}) {
    for (const double frequency : {50.0, 12.5}) {
      const auto found = motor_of_tests(truth.rs, {50.0, phase_impedance(truth, 50.0, 0.0)},
                                        {frequency, phase_impedance(truth, frequency, 1.0)});
      REQUIRE(found);
      CHECK(found->rs == Approx(truth.rs).epsilon(1e-12));
      CHECK(found->rr == Approx(truth.rr).epsilon(1e-10));
      CHECK(found->ls == Approx(truth.ls).epsilon(1e-12));
      CHECK(found->lr == Approx(truth.lr).epsilon(1e-12));
      CHECK(found->lm == Approx(truth.lm).epsilon(1e-10));
    }
  }
}

TEST_CASE("classical tests: impedances that no motor has are refused by name") {
  const PhaseImpedance open{50, phase_impedance(kTable1, 50, 0)}, locked{50, phase_impedance(kTable1, 50, 1)};
  CHECK(motor_of_tests(0, open, locked).error().text == "dc: resistance is 0 ohm, allowed: above 0");
  CHECK(motor_of_tests(6.6, {50, {6.6, -1}}, locked).error().text ==
        "no_load: 6.6 + j -1 ohm at 50 Hz; allowed: frequency and reactance above 0");
  CHECK(motor_of_tests(6.6, open, {0, {12, 1}}).error().text ==
        "locked_rotor: 12 + j 1 ohm at 0 Hz; allowed: a frequency above 0");
  CHECK(motor_of_tests(6.6, {50, {6.6, 150}}, {50, {5, 20}}).error().text ==
        "locked_rotor: 5 + j 20 ohm at 50 Hz; allowed with 6.6 ohm at dc and 6.6 + j 150 ohm at 50 Hz without load: more "
        "resistance than at dc and less reactance than without load");
}

TEST_CASE("supply: each sample is the mean of the sine over its period, alpha ahead of beta by a quarter") {
  BlockDriver<Supply> supply;
  supply.set("sample_rate", kRate).set("voltage", 230.0).set("frequency", 50.0);
  supply.configure();
  CHECK(supply.resolve({})[0].channels == 2);
  supply.activate(1000, Rate::from_hz(kRate));
  const Channels u = supply.process({}, 1000)[0];
  const double omega = kTurn * 50, peak = 230 * std::numbers::sqrt2;
  const auto integral = [&](double t) { return Complex(std::sin(omega * t), -std::cos(omega * t)) * (peak / omega); };
  for (std::size_t n = 0; n < 1000; ++n) {
    const double t = static_cast<double>(n) / kRate;
    const Complex mean = (integral(t + 1 / kRate) - integral(t)) * kRate;
    REQUIRE(std::abs(Complex(u[0][n], u[1][n]) - mean) < 1e-8);
  }
}

TEST_CASE("supply: at frequency 0 it is one direct voltage, and frequencies it cannot sample are refused") {
  BlockDriver<Supply> supply;
  supply.set("sample_rate", kRate).set("voltage", -12.5).set("frequency", 0.0);
  supply.configure();
  CHECK(supply.resolve({})[0].channels == 1);
  supply.activate(3, Rate::from_hz(kRate));
  CHECK(supply.process({}, 3)[0][0] == std::vector<double>{-12.5, -12.5, -12.5});
  BlockDriver<Supply> fast;
  fast.set("sample_rate", kRate).set("voltage", 1.0).set("frequency", 1001.0);
  CHECK(failure_of([&] { fast.configure(); }) == "frequency is above a tenth of the sample_rate, allowed: up to it");
}

TEST_CASE("power meter: a held voltage on resistance and inductance shows their impedance and powers") {
  // i[n+1] of R and L under the held voltage, exact.
  const double r = 6.6, l = 0.041, frequency = 50, pole = std::exp(-r / l / kRate);
  BlockDriver<Supply> supply;
  supply.set("sample_rate", kRate).set("voltage", 100.0).set("frequency", frequency);
  supply.configure();
  supply.resolve({});
  const std::size_t count = 8000;
  supply.activate(count, Rate::from_hz(kRate));
  const Channels u = supply.process({}, count)[0];
  Channels i(2, std::vector<double>(count));
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t n = 0; n + 1 < count; ++n) i[c][n + 1] = pole * i[c][n] + (1 - pole) / r * u[c][n];
  }
  BlockDriver<PowerMeter> meter;
  meter.set("skip", 0.3).set("frequency", frequency);
  measure(meter, u, i);
  const RecordView record(*meter.records()[0]);
  const double x = kTurn * frequency * l, current = 100 / std::hypot(r, x);
  CHECK(record.integer("cycles") == 25);
  CHECK(record.number("resistance").value() == Approx(r).epsilon(2e-4));
  CHECK(record.number("reactance").value() == Approx(x).epsilon(1e-4));
  CHECK(record.number("voltage").value() == Approx(100).epsilon(2e-4));
  CHECK(record.number("current").value() == Approx(current).epsilon(2e-4));
  CHECK(record.number("active_power").value() == Approx(3 * current * current * r).epsilon(3e-4));
  CHECK(record.number("reactive_power").value() == Approx(3 * current * current * x).epsilon(3e-4));
}

TEST_CASE("power meter: one channel pulsates with half the power, direct current is a mean") {
  Channels u(1), i(1);
  for (int n = 0; n < 1000; ++n) {
    u[0].push_back(10 * std::cos(kTurn * n / 100));
    i[0].push_back(2 * std::cos(kTurn * n / 100 - 0.5));
  }
  BlockDriver<PowerMeter> sampled;
  sampled.set("frequency", 100.0).set("voltage_is", "sampled");
  measure(sampled, u, i);
  const RecordView ac(*sampled.records()[0]);
  CHECK(ac.number("resistance").value() == Approx(5 * std::cos(0.5)).epsilon(1e-12));
  CHECK(ac.number("reactance").value() == Approx(5 * std::sin(0.5)).epsilon(1e-12));
  double mean = 0;
  for (std::size_t n = 0; n < 1000; ++n) mean += 1.5 * u[0][n] * i[0][n] / 1000;
  CHECK(ac.number("active_power").value() == Approx(mean).epsilon(1e-12));
  BlockDriver<PowerMeter> direct;
  direct.set("frequency", 0.0);
  measure(direct, {{6, 6, 6, 6}}, {{2, 1, 0, 1}});
  const RecordView dc(*direct.records()[0]);
  CHECK(dc.number("resistance").value() == 6.0);
  CHECK(dc.number("reactance").value() == 0.0);
  CHECK(dc.number("active_power").value() == 9.0);
}

TEST_CASE("power meter: streams and frequencies that do not fit are refused") {
  BlockDriver<PowerMeter> meter;
  meter.set("frequency", 60.0);
  meter.configure();
  CHECK(failure_of([&] {
          meter.resolve({stream(1), stream(1)});
        }) == "a cycle of 60 Hz has 166.667 samples, allowed: a whole number from 4 to 1e9");
  CHECK(failure_of([&] {
          meter.resolve({stream(1, 6000), stream(2, 6000)});
        }) == "'voltage' has 1 channel, 'current' 2; allowed: both 1 (alpha), or both 2 (alpha, beta)");
  BlockDriver<PowerMeter> still;
  CHECK(failure_of([&] { measure(still, {std::vector<double>(199, 1.0)}, {std::vector<double>(199, 1.0)}); }) ==
        "no whole cycle of 200 samples after skip; allowed: one or more");
  BlockDriver<PowerMeter> broken;
  CHECK(failure_of([&] { measure(broken, {{1, 2}}, {{0, std::nan("")}}); }) == "'current' is not finite at sample 1");
}

TEST_CASE("classical tests: the block refuses tests that are absent, doubled or at a wrong frequency") {
  ClassicalTests tests;
  give(tests, ClassicalTests::dc, measurement(0, 6.6));
  CHECK(failure_of([&] { give(tests, ClassicalTests::dc, measurement(0, 6.6)); }) == "dc: a second record arrived, allowed: one");
  CHECK(failure_of([&] { give(tests, ClassicalTests::no_load, measurement(0, 6.6)); }) ==
        "no_load: a test at 0 Hz, allowed: above 0 Hz");
  CHECK(failure_of([&] { give(tests, ClassicalTests::locked_rotor, RecordBuilder("power_measurement")); }) ==
        "locked_rotor: no number 'frequency' in the record");
  bf_process process{};
  const bf_host host{};
  Io io(process, host);
  ClassicalTests empty;
  CHECK(failure_of([&] { empty.finish(io); }) == "no record arrived at 'dc', allowed: one");
}
