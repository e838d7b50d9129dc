#include "catch.hpp"
#include "drive/induction_motor_block.hpp"
#include "drive/inverter_block.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;
using namespace bodeflow::test;

namespace {

const Rate kRate{10000, 1};

StreamFacts one_channel() {
  StreamFacts f;
  f.known = true;
  f.channels = 1;
  f.rate = kRate;
  return f;
}

struct MotorBench {
  explicit MotorBench(double thermal_time = 300.0, double drift = 0.0) {
    block.set("rs", 6.6).set("rr", 5.5).set("ls", 0.475).set("lr", 0.475).set("lm", 0.454);
    block.set("thermal_time", thermal_time).set("resistance_drift", drift);
    block.configure();
    block.resolve({StreamFacts{}, one_channel(), StreamFacts{}});
    block.activate(1 << 20, kRate);
  }
  /// The current after so many periods of 33 V.
  double run(std::size_t periods) {
    const auto out = block.process({{}, {std::vector<double>(periods, 33.0)}, {}}, periods);
    return out[0][0].back();
  }
  BlockDriver<InductionMotor> block;
};

RecordBuilder properties() { return RecordBuilder("bench_properties"); }

}  // namespace

TEST_CASE("induction motor: hidden properties replace its parameters, leave its currents alone, and end with a reset") {
  MotorBench bench;
  const double cold = bench.run(40000);
  CHECK(cold == Approx(5.0).epsilon(1e-9));
  bench.block.receive(properties().set("effect", "other").set("rs", 3.3).set("saturation_current", 2.0).set("dead_time", 1e-6),
                      0);
  CHECK(bench.run(1) == Approx(cold).epsilon(0.02));
  CHECK(bench.run(100000) == Approx(10.0).epsilon(1e-6));
  bench.block.reset();
  CHECK(bench.run(40000) == cold);
}

TEST_CASE("induction motor: the stator resistance drifts along an exponential") {
  MotorBench bench(2.0, 0.2);
  CHECK(bench.run(40000) == Approx(33.0 / (6.6 * (1 + 0.2 * (1 - std::exp(-2.0))))).epsilon(2e-3));
  CHECK(bench.run(400000) == Approx(33.0 / (6.6 * 1.2)).epsilon(1e-6));
}

TEST_CASE("induction motor and inverter: bad hidden properties are refused by name") {
  MotorBench bench;
  const auto refusal = [&](const RecordBuilder& r) { return failure_of([&] { bench.block.receive(r, 0); }); };
  CHECK(refusal(properties().set("saturation_current", "small")) == "property saturation_current is not a number");
  CHECK(refusal(properties().set("bar_height", 0.06)) ==
        "bench_properties: bar_height = 0.06 m: slots of that height have more leakage than the 0.0410716 H of the whole motor");
  BlockDriver<Inverter> inverter;
  inverter.configure();
  inverter.resolve({one_channel(), one_channel(), StreamFacts{}});
  inverter.activate(16, kRate);
  CHECK(failure_of([&] { inverter.receive(properties().set("dead_time", 1.0), 0); }) ==
        "property dead_time = 1, allowed: 0 to 2e-05");
  inverter.receive(properties().set("dead_time", 1.5e-6), 0);
  const auto out = inverter.process({{{20.0}}, {{0.3}}, {}}, 1);
  CHECK(out[1][0][0] == Approx(20.0 - 10.8));
}
