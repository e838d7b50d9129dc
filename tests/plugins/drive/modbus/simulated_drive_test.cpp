#include "simulated/simulated_drive.hpp"

#include "catch.hpp"

using namespace bodeflow::drive::simulated;
using Written = SimulatedDrive::Written;

namespace {

Written write(SimulatedDrive& d, int address, std::uint16_t word) { return d.write(address, &word, 1); }

void target(SimulatedDrive& d, double rpm) {
  const auto bits = static_cast<std::uint32_t>(static_cast<std::int32_t>(rpm * 10));
  const std::uint16_t words[] = {static_cast<std::uint16_t>(bits >> 16U), static_cast<std::uint16_t>(bits)};
  REQUIRE(d.write(0x20, words, 2) == Written::done);
}

/// Time passes while a client is heard.
void run(SimulatedDrive& d, double seconds) {
  for (double t = 0.0; t < seconds; t += 0.01) {
    d.heard();
    d.advance(0.01);
  }
}

void enable(SimulatedDrive& d, std::uint16_t watchdog_ms = 100) {
  write(d, 0x11, 3);
  write(d, 0x12, watchdog_ms);
  for (const std::uint16_t word : std::initializer_list<std::uint16_t>{0x06, 0x07, 0x0F}) write(d, 0x10, word);
  run(d, 0.2);
  REQUIRE(d.state() == State::enabled);
}

}  // namespace

TEST_CASE("simulated drive: the motor follows its target by the ramp and holds it under load") {
  SimulatedDrive d;
  enable(d);
  target(d, 900);
  run(d, 0.3);
  CHECK(d.speed_rpm() == Approx(450).margin(15));  // 1500 rpm/s
  run(d, 0.6);
  CHECK(d.speed_rpm() == Approx(900).margin(2));
  const std::uint16_t brake[] = {0x0000, 0x40A0};  // 5 Nm, low word first
  REQUIRE(d.write(0x22, brake, 2) == Written::done);
  run(d, 0.6);
  CHECK(d.speed_rpm() == Approx(900).margin(2));
  CHECK(0.01 * d.read(0x34).value() == Approx(2.84).margin(0.05));  // A: 3.49 A peak for the field, 2 A for the torque
  target(d, -900);
  run(d, 2.0);
  CHECK(d.speed_rpm() == Approx(-900).margin(2));
}

TEST_CASE("simulated drive: quick stop brakes faster than the ramp and ends with the output stage off") {
  SimulatedDrive d;
  enable(d);
  target(d, 1000);
  run(d, 1.0);
  write(d, 0x10, 0x02);
  CHECK(d.state() == State::quick_stop);
  CHECK(d.output_stage_on());
  run(d, 0.35);
  CHECK(d.state() == State::switch_on_disabled);
  CHECK(std::abs(d.speed_rpm()) < 5.0);
  CHECK_FALSE(d.output_stage_on());
}

TEST_CASE("simulated drive: silence for longer than the watchdog stops the motor and leaves fault 0x8130") {
  SimulatedDrive d;
  enable(d, 100);
  target(d, 600);
  run(d, 0.8);
  d.heard();
  d.advance(0.099);
  CHECK(d.state() == State::enabled);
  d.advance(0.003);
  CHECK(d.state() == State::fault_reaction);
  d.advance(0.3);
  CHECK(d.state() == State::fault);
  CHECK(d.fault_code() == 0x8130);
  CHECK(std::abs(d.speed_rpm()) < 5.0);
  CHECK_FALSE(d.output_stage_on());
  write(d, 0x10, 0x0F);
  CHECK(d.state() == State::fault);
  write(d, 0x10, 0x80);
  CHECK(d.state() == State::switch_on_disabled);
  CHECK(d.fault_code() == 0);
}

TEST_CASE("simulated drive: steps of the state machine that CiA 402 does not have change nothing") {
  SimulatedDrive d;
  write(d, 0x11, 3);
  write(d, 0x10, 0x0F);
  CHECK(d.state() == State::switch_on_disabled);
  write(d, 0x10, 0x07);
  CHECK(d.state() == State::switch_on_disabled);
  write(d, 0x10, 0x06);
  CHECK(d.state() == State::ready);
  write(d, 0x10, 0x00);
  CHECK(d.state() == State::switch_on_disabled);
}

TEST_CASE("simulated drive: values that are not allowed and half a value of 32 bits change nothing") {
  SimulatedDrive d;
  const std::uint16_t too_fast[] = {0x0000, 0x3A99};  // 1500.1 rpm
  CHECK(d.write(0x20, too_fast, 2) == Written::bad_value);
  CHECK(d.write(0x20, too_fast, 1) == Written::no_such_register);
  CHECK(d.write(0x30, too_fast, 1) == Written::no_such_register);
  CHECK(write(d, 0x13, 0) == Written::bad_value);
  const std::uint16_t two[] = {3, 60'000};  // mode is right, the watchdog is too long
  CHECK(d.write(0x11, two, 2) == Written::bad_value);
  CHECK(d.read(0x11) == 0);
  CHECK(d.read(0x21) == 0);
  CHECK_FALSE(d.read(0x14).has_value());
  CHECK_FALSE(d.read(0x1000 + 2000).has_value());
}

TEST_CASE("simulated drive: the trace holds a thousand samples of the run that follows") {
  SimulatedDrive d;
  enable(d);
  target(d, 600);
  write(d, 0x50, 1);
  run(d, 0.9);
  CHECK(d.read(0x51) == 0);
  run(d, 0.2);
  CHECK(d.read(0x51) == 1);
  const auto speed = [&](int n) { return 0.1 * static_cast<std::int16_t>(d.read(0x1000 + 2 * n).value()); };
  CHECK(speed(0) == Approx(0).margin(1));
  CHECK(speed(200) == Approx(300).margin(15));
  CHECK(speed(999) == Approx(600).margin(2));
}
