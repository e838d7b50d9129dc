#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "drive/current_sensor_block.hpp"
#include "drive/induction_motor_block.hpp"
#include "drive/inverter_block.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;
using namespace bodeflow::test;

namespace {

const Rate kRate{10000, 1};

StreamFacts one_channel(const char* unit) {
  StreamFacts f;
  f.known = true;
  f.channels = 1;
  f.rate = kRate;
  f.unit = unit;
  return f;
}

/// Currents of the motor of Table 1, with 33 V of that sign, behind a bad terminal.
std::vector<double> currents(const char* fault, double ohm, double volts, std::size_t periods) {
  BlockDriver<InductionMotor> block;
  block.set("rs", 6.6).set("rr", 5.5).set("ls", 0.475).set("lr", 0.475).set("lm", 0.454).set("seed", std::int64_t{4});
  block.configure();
  block.resolve({StreamFacts{}, one_channel("V"), StreamFacts{}});
  block.activate(1 << 20, kRate);
  block.receive(RecordBuilder("bench_properties").set(fault, ohm), 0);
  return block.process({{}, {std::vector<double>(periods, volts)}, {}}, periods)[0][0];
}

}  // namespace

TEST_CASE("bench faults: a corroded terminal lets less current through one way than the other") {
  // The drop acts in phase a alone: two thirds of it in the vector.
  CHECK(currents("rectifying_resistance", 0.9, 33, 40000).back() == Approx(33 / (6.6 + 0.6)).epsilon(1e-4));
  CHECK(currents("rectifying_resistance", 0.9, -33, 40000).back() == Approx(-33 / (6.6 - 0.6)).epsilon(1e-4));
}

TEST_CASE("bench faults: a loose terminal changes between two currents, each about as often") {
  const std::vector<double> i = currents("contact_resistance", 0.9, 33, 600000);
  int firm = 0, loose = 0;
  double least = 10, greatest = 0;
  for (std::size_t n = 10000; n < i.size(); ++n) {
    least = std::min(least, i[n]);
    greatest = std::max(greatest, i[n]);
    (i[n] > 0.5 * (5 + 33 / 7.2) ? firm : loose) += 1;
  }
  CHECK(least == Approx(33 / 7.2).epsilon(1e-4));
  CHECK(greatest == Approx(5).epsilon(1e-4));
  // 150 changes in the mean: the share of a state is 1/2 +- 0.04.
  CHECK(firm > 0.34 * (firm + loose));
  CHECK(loose > 0.34 * (firm + loose));
}

TEST_CASE("bench faults: the link's ripple goes through to the voltage, the modulation does not know it") {
  BlockDriver<Inverter> block;
  block.configure();
  block.resolve({one_channel("V"), StreamFacts{}, StreamFacts{}});
  block.activate(1 << 10, kRate);
  block.receive(RecordBuilder("bench_properties").set("link_ripple", 0.05), 0);
  const auto out = block.process({{std::vector<double>(100, 100.0)}, {}, {}}, 100);
  for (std::size_t n = 0; n < 100; ++n) {
    const double rise = 1 + 0.05 * std::sin(2 * std::numbers::pi * static_cast<double>(n) / 100);
    CHECK(out[1][0][n] == Approx(100 * rise).epsilon(1e-12));
    CHECK(out[0][4][n] == Approx(540 * rise).epsilon(1e-12));
  }
}

TEST_CASE("bench faults: the gain of a current sensor wobbles, and a correction takes an offset away") {
  BlockDriver<CurrentSensor> block;
  block.set("correction", 0.25);
  block.configure();
  block.resolve({one_channel("A")});
  block.activate(1 << 10, kRate);
  block.receive(RecordBuilder("bench_properties").set("current_wobble", 0.1).set("current_wobble_frequency", 50.0), 0);
  const auto y = block.process({{std::vector<double>(200, 2.0)}}, 200)[0][0];
  for (std::size_t n = 0; n < 200; ++n)
    CHECK(y[n] == Approx(2 * (1 + 0.1 * std::sin(2 * std::numbers::pi * static_cast<double>(n) / 200)) - 0.25).epsilon(1e-12));
}
