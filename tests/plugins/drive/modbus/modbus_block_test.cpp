#include "modbus_block.hpp"

#include "../../block_driver.hpp"
#include "../../loaded_block.hpp"
#include "catch.hpp"
#include "modbus_trace_block.hpp"

using namespace bodeflow;
using drive::modbus::ModbusBlock;
using drive::modbus::ModbusTraceBlock;
using test::BlockDriver;
using test::refusal_of;
using Texts = std::vector<std::string>;

namespace {

const std::string kMap = BODEFLOW_SOURCE_DIR "/graphs/drive/maps/simulated_drive.yaml";

struct Driver : BlockDriver<ModbusBlock> {
  Driver() {
    set("map", kMap)
        .set("poll_rate", 50.0)
        .set("set_points", Texts{"target_speed"})
        .set("measurements", Texts{"speed", "torque"});
  }
};

StreamFacts target(double rate_hz, const std::string& unit = "rpm", int channels = 1) {
  StreamFacts f;
  f.known = true;
  f.channels = channels;
  f.rate = Rate::from_hz(rate_hz);
  f.unit = unit;
  return f;
}

}  // namespace

TEST_CASE("modbus block: its streams have the poll rate and the names and units of the registers") {
  Driver d;
  d.set("feedback", Texts{"speed"});
  d.configure();
  const auto out = d.resolve({target(50)});
  REQUIRE(out.size() == 3);
  CHECK(out[0].rate.hz() == 50.0);
  CHECK(out[0].channel_names == Texts{"speed", "torque"});
  CHECK(out[0].channel_units == Texts{"rpm", "Nm"});
  CHECK(out[0].unit == "");
  CHECK(out[1].channel_names == Texts{"speed"});
  CHECK(out[1].unit == "rpm");
  CHECK(out[2].channel_names == Texts{"state", "enabled", "fault_code", "statusword", "late"});
}

TEST_CASE("modbus block: a loop that is faster than the drive is polled is refused and so is a slower one") {
  Driver d;
  d.configure();
  CHECK(refusal_of([&] { d.resolve({target(100)}); }) ==
        "'set_points' has 100 samples/s, the drive is polled 50 times a second (poll_rate): the loop is faster than the drive "
        "takes "
        "set points; allowed: a slower loop, or filters.decimate before the drive");
  CHECK(refusal_of([&] { d.resolve({target(25)}); }) ==
        "'set_points' has 25 samples/s, the drive is polled 50 times a second (poll_rate); allowed: the same rate (filters.hold "
        "raises it)");
}

TEST_CASE("modbus block: a poll rate above that of the register map is refused") {
  Driver d;
  d.set("poll_rate", 250.0);
  CHECK(refusal_of([&] { d.configure(); }) == "poll_rate is 250 Hz, allowed by " + kMap + ": at most 200 Hz");
}

TEST_CASE("modbus block: set points of another unit or number are refused") {
  Driver d;
  d.configure();
  CHECK(refusal_of([&] { d.resolve({target(50, "rad/s")}); }) ==
        "set point 'target_speed' is in rpm, channel 0 of 'set_points' is in rad/s; allowed: the same unit");
  CHECK(refusal_of([&] { d.resolve({target(50, "rpm", 2)}); }) ==
        "'set_points' has 2 channels, parameter set_points names 1 register");
  CHECK(refusal_of([&] { d.resolve({target(50, "")}); }) == "no failure");
}

TEST_CASE("modbus block: registers that can not be had are named with those that can") {
  const auto refusal = [](const char* parameter, const Texts& names) {
    Driver d;
    d.set(parameter, names);
    return refusal_of([&] { d.configure(); });
  };
  CHECK(refusal("measurements", {"sped"}) ==
        "measurements: 'sped' is no register that can be read (did you mean 'speed'?), allowed: vendor, product, controlword, "
        "mode, watchdog, ramp, target_speed, load_torque, statusword, fault_code, speed, current, torque, link_voltage, "
        "output_stage, trace_arm, trace_done");
  const std::string writable = ", allowed: mode, ramp, target_speed, load_torque, trace_arm";
  CHECK(refusal("set_points", {"speed"}) == "set_points: 'speed' is no register that can be written" + writable);
  CHECK(refusal("set_points", {"controlword"}) == "set_points: 'controlword' is no register that can be written" + writable);
  CHECK(refusal("set_points", {"ramp", "ramp"}) == "set_points: 'ramp' stands twice");
  CHECK(refusal("feedback", {"current"}) == "feedback: 'current' is none of the measurements, allowed: speed, torque");
}

TEST_CASE("modbus block: a watchdog of less than three periods is refused") {
  Driver d;
  d.set("watchdog", 0.05);
  CHECK(refusal_of([&] { d.configure(); }) == "watchdog is 50 ms, allowed at poll_rate 50 Hz: at least three periods, 60 ms");
}

TEST_CASE("modbus block: a watchdog beyond the limits of its register is refused") {
  Driver d;
  d.set("watchdog", 12.0);
  CHECK(refusal_of([&] { d.configure(); }) == "watchdog is 12000 ms, allowed by " + kMap + ": 10 to 10000 ms");
}

TEST_CASE("modbus block: a cycle that takes longer on a serial line than a period of polling is refused") {
  Driver d;
  d.set("connection", "rtu").set("device", std::string("/dev/ttyUSB0")).set("baud", std::int64_t{9600});
  // set point 9 + 4 + 8 characters, controlword 16, statusword to speed 13 + 8, torque 13 + 4: 75 of 11 bits, and 8 silences
  // of 3.5
  CHECK(refusal_of([&] { d.configure(); }) ==
        "a cycle takes 118.021 ms on a line at 9600 baud, poll_rate 50 Hz leaves 20 ms; allowed: at most 8.47 Hz, or fewer "
        "registers, or a faster line");
  Driver fast;
  fast.set("connection", "rtu").set("device", std::string("/dev/ttyUSB0")).set("baud", std::int64_t{1'000'000});
  CHECK(refusal_of([&] { fast.configure(); }) == "no failure");
}

TEST_CASE("modbus block: a clock that does not pace and chunks of several samples are refused before anything is written") {
  Driver d;
  d.configure();
  d.resolve({target(50)});
  CHECK(refusal_of([&] { d.activate(1, Rate(50, 1)); }) ==
        "a real drive is behind this block, it can't run as fast as the computer: found run: {clock: simulated}, allowed: run: "
        "{clock: realtime, chunk: 1}");
}

TEST_CASE("modbus block: says beforehand which drive it runs and how late a loop through it is") {
  Driver d;
  d.configure();
  CHECK(
      d.advise({target(50)}) ==
      Texts{
          "drives 127.0.0.1:502 unit 1, 50 cycles a second; a loop through it has 40 ms of delay; the drive's watchdog is set to "
          "500 ms",
          "set point 'target_speed' has the limits -1500 to 1500 rpm, beyond them the drive is stopped",
          "measured 'speed' has the limits -1800 to 1800 rpm, beyond them the drive is stopped in the same cycle",
          "measured 'torque' has the limits -40 to 40 Nm, beyond them the drive is stopped in the same cycle"});
}

TEST_CASE("modbus trace block: the stream has rate and length and channels of the trace in the map") {
  BlockDriver<ModbusTraceBlock> d;
  d.set("map", kMap);
  d.configure();
  const auto out = d.resolve({});
  CHECK(out[0].rate.hz() == 1000.0);
  CHECK(out[0].length == 1000);
  CHECK(out[0].channel_names == Texts{"speed", "torque"});
  CHECK(out[0].channel_units == Texts{"rpm", "Nm"});
}
