#include <cmath>

#include "catch.hpp"
#include "drive/axis_block.hpp"
#include "drive/command_buffer_block.hpp"
#include "drive/friction_feed_forward_block.hpp"
#include "plugins/block_driver.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;
using namespace bodeflow::test;

namespace {

const Rate kRate{1000, 1};

StreamFacts one_channel(const char* unit) {
  StreamFacts f;
  f.known = true;
  f.channels = 1;
  f.rate = kRate;
  f.unit = unit;
  return f;
}

struct AxisBench {
  explicit AxisBench(double friction = 0.0) {
    block.set("motor_friction", friction);
    block.configure();
    block.resolve({one_channel("Nm"), one_channel("Nm"), StreamFacts{}});
    block.activate(1 << 20, kRate);
  }
  double speed_after(std::size_t n, double torque, double compensation) {
    return block.process({{std::vector<double>(n, torque)}, {std::vector<double>(n, compensation)}, {}}, n)[0][0].back();
  }
  BlockDriver<AxisBlock> block;
};

std::vector<double> buffered(double lead_s, std::vector<double> commands) {
  BlockDriver<CommandBuffer> block;
  block.set("samples", std::int64_t{3}).set("lead", lead_s);
  block.configure();
  block.resolve({one_channel("V")});
  block.activate(1 << 10, kRate);
  return block.process({{commands}}, commands.size())[0][0];
}

}  // namespace

TEST_CASE("axis block: torque and compensation add up, and constant torque leads to the speed that friction allows") {
  CHECK(AxisBench().speed_after(20000, 0.3, 0.1) == Approx(0.4 / 0.02).epsilon(1e-6));
  CHECK(AxisBench(0.1).speed_after(20000, 0.3, 0.0) == Approx(0.2 / 0.02).epsilon(1e-6));
  CHECK(AxisBench(0.1).speed_after(20000, 0.3, 0.1) == Approx(0.3 / 0.02).epsilon(1e-6));
  CHECK(AxisBench(0.1).speed_after(20000, 0.09, 0.0) == 0.0);
}

TEST_CASE("axis block: hidden properties replace its parameters before the first sample, and a reset takes them back") {
  AxisBench bench;
  bench.block.receive(RecordBuilder("bench_properties").set("motor_friction", 0.1).set("motor_viscosity", 0.03), 0);
  CHECK(bench.speed_after(20000, 0.3, 0.0) == Approx(0.2 / 0.04).epsilon(1e-6));
  bench.block.reset();
  CHECK(bench.speed_after(20000, 0.3, 0.0) == Approx(0.3 / 0.02).epsilon(1e-6));
  AxisBench other;
  CHECK(failure_of([&] { other.block.receive(RecordBuilder("bench_properties").set("backlash", -1.0), 0); }) ==
        "property backlash = -1, allowed: 0 to 10");
  CHECK(failure_of([&] { other.block.receive(RecordBuilder("bench_properties").set("stiffness", 0.0), 0); }) ==
        "bench_properties: motor_inertia, load_inertia and stiffness, allowed: above 0");
}

TEST_CASE("axis block: a torque that is not finite is refused") {
  AxisBench bench;
  CHECK(failure_of([&] { bench.speed_after(3, std::nan(""), 0.0); }) == "'torque' is not finite at sample 0");
}

TEST_CASE("friction feed-forward: the torque by the sign of the speed, straight below the threshold") {
  BlockDriver<FrictionFeedForward> block;
  block.set("torque", 0.05).set("threshold", 0.2);
  block.configure();
  CHECK(block.resolve({one_channel("rad/s")})[0].unit == "Nm");
  block.activate(16, kRate);
  CHECK(block.process({{{-3, -0.1, 0, 0.1, 3}}}, 5)[0][0] == std::vector<double>{-0.05, -0.025, 0, 0.025, 0.05});
}

TEST_CASE("command buffer: a lead brings commands forward, parts of a sample by the mean over it") {
  const std::vector<double> commands{1, 2, 4, 8, 16, 32};
  CHECK(buffered(0, commands) == std::vector<double>{0, 0, 0, 1, 2, 4});
  CHECK(buffered(2e-3, commands) == std::vector<double>{0, 1, 2, 4, 8, 16});
  CHECK(buffered(3e-3, commands) == commands);
  const std::vector<double> half = buffered(0.5e-3, commands);
  CHECK(half[3] == Approx(0.5 * 2 + 0.5 * 1));
  CHECK(half[5] == Approx(0.5 * 8 + 0.5 * 4));
  CHECK(failure_of([&] { buffered(4e-3, commands); }) == "lead = 0.004 s, allowed: at most the buffer's 0.003 s");
}
