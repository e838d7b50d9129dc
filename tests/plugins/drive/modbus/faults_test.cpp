// Each kind of fault ends in the safe state, and the drive itself proves it: the motor stands, the output stage is off.
#include "catch.hpp"
#include "drive_bench.hpp"

using bodeflow::test::DriveBench;
using bodeflow::test::DriveClient;
using namespace bodeflow::drive::modbus;
using bodeflow::drive::simulated::Disturbance;
using Catch::Matchers::Contains;

namespace {

constexpr const char* kLeftToWatchdog = "its own watchdog of 800 ms is left to stop it";
constexpr const char* kConfirmed = "the drive was stopped and confirms switch_on_disabled";

struct Expected {
  const char* failure;
  const char* stop;
  int fault_code;
};

/// A motor that runs meets a disturbance.
void disturb_and_check(bool is_tcp, Disturbance kind, int count, const Expected& expected) {
  DriveBench bench(is_tcp);
  DriveClient client(bench.setup());
  REQUIRE(client.run_up() == "");
  bench.server().disturb(kind, count);
  CHECK_THAT(client.failure(), Contains(expected.failure));
  CHECK_THAT(client.poller().stop().text, Contains(expected.stop));
  CHECK(client.poller().stop().confirmed == (expected.stop == kConfirmed));
  CHECK(bench.stops());
  CHECK(bench.fault_code() == expected.fault_code);
}

}  // namespace

TEST_CASE("fault: no answer on TCP within the time leaves the motor stopped by the drive's watchdog") {
  disturb_and_check(true, Disturbance::silent, -1, {"no whole answer within 250 ms", kLeftToWatchdog, 0x8130});
}

TEST_CASE("fault: no answer on a serial line within the time leaves the motor stopped by the drive's watchdog") {
  disturb_and_check(false, Disturbance::silent, -1, {"no whole answer within 250 ms", kLeftToWatchdog, 0x8130});
}

TEST_CASE("fault: one lost answer ends in a quick stop that the drive confirms") {
  for (const bool is_tcp : {true, false}) {
    disturb_and_check(is_tcp, Disturbance::silent, 1, {"no whole answer within 250 ms", kConfirmed, 0});
  }
}

TEST_CASE("fault: half a frame ends in a quick stop that the drive confirms") {
  for (const bool is_tcp : {true, false}) {
    disturb_and_check(is_tcp, Disturbance::half_frame, 1, {"no whole answer within 250 ms", kConfirmed, 0});
  }
}

TEST_CASE("fault: half frames only leave the motor stopped by the drive's watchdog") {
  disturb_and_check(true, Disturbance::half_frame, -1, {"no whole answer within 250 ms", kLeftToWatchdog, 0x8130});
}

TEST_CASE("fault: a damaged answer ends in a quick stop that the drive confirms") {
  disturb_and_check(true, Disturbance::damaged, 1, {"an answer that is not one to the question", kConfirmed, 0});
  disturb_and_check(false, Disturbance::damaged, 1, {"an answer with a wrong checksum", kConfirmed, 0});
}

TEST_CASE("fault: a reset connection is opened again for the quick stop") {
  disturb_and_check(true, Disturbance::reset, 1, {"the connection was reset by the device", kConfirmed, 0});
}

TEST_CASE("fault: a connection that is reset again and again leaves the motor stopped by the drive's watchdog") {
  disturb_and_check(true, Disturbance::reset, -1, {"the connection was reset by the device", kLeftToWatchdog, 0x8130});
}

TEST_CASE("fault: an exception of the device ends in a quick stop that the drive confirms") {
  for (const bool is_tcp : {true, false}) {
    disturb_and_check(is_tcp, Disturbance::exception, 1, {"the device answers with exception 4 (device failure)", kConfirmed, 0});
  }
}

TEST_CASE("fault: exceptions only leave the motor stopped by the drive's watchdog") {
  disturb_and_check(true, Disturbance::exception, -1,
                    {"the device answers with exception 4 (device failure)", kLeftToWatchdog, 0x8130});
}

TEST_CASE("fault: a lost connection that is refused afterwards leaves the motor stopped by the drive's watchdog") {
  disturb_and_check(true, Disturbance::gone, -1, {"the connection was reset by the device", kLeftToWatchdog, 0x8130});
}

TEST_CASE("fault: a serial line that is pulled leaves the motor stopped by the drive's watchdog") {
  disturb_and_check(false, Disturbance::gone, -1, {"", kLeftToWatchdog, 0x8130});
}

TEST_CASE("fault: a measured value outside of its limits ends in a quick stop that the drive confirms") {
  DriveBench bench;
  DriveClient client(bench.setup());
  REQUIRE(client.run_up() == "");
  bench.server().with_drive([](auto& d) { d.show_speed(2500.0); });
  const std::int64_t cycles = client.poller().counts().cycles;
  CHECK_THAT(client.failure(),
             Contains("limit violated: speed (holding register 0x0032) is 2500 rpm, allowed: -1800 to 1800 rpm"));
  CHECK(client.poller().counts().cycles <= cycles + 1);  // one that had read before
  bench.server().with_drive([](auto& d) { d.show_speed(std::nullopt); });
  CHECK(client.poller().stop().confirmed);
  CHECK(bench.stops());
  CHECK(bench.fault_code() == 0);
}

TEST_CASE("fault: a fault of the drive is named and its output stage is off") {
  DriveBench bench;
  DriveClient client(bench.setup());
  REQUIRE(client.run_up() == "");
  bench.server().with_drive([](auto& d) { d.trip(0x2310); });
  CHECK_THAT(client.failure(), Contains("the drive has stopped by itself, fault 0x2310: continuous over current"));
  CHECK(client.poller().stop().text == "the drive was stopped and confirms fault");
  CHECK_FALSE(bench.output_stage_on());
}

TEST_CASE("fault: a fault on the way to operation_enabled is not reset but ends the run") {
  DriveBench bench;
  SessionSetup setup = bench.setup();
  setup.map.setup.clear();  // without its mode the simulated drive stays in switched_on
  setup.reset_faults = true;
  DriveClient client(setup);
  REQUIRE(client.run_until([](const Polled& p) { return p.state == DriveState::switched_on; }) == "");
  bench.server().with_drive([](auto& d) { d.trip(0x2340); });
  CHECK_THAT(client.failure(), Contains("the drive has stopped by itself, fault 0x2340: short circuit"));
  CHECK(bench.fault_code() == 0x2340);
}

TEST_CASE("fault: a client that hangs is stopped by the drive's watchdog and told so") {
  DriveBench bench;
  DriveClient client(bench.setup());
  REQUIRE(client.run_up() == "");
  CHECK(bench.stops());  // nobody polls meanwhile
  CHECK(bench.fault_code() == 0x8130);
  CHECK_THAT(client.failure(), Contains("the drive has stopped by itself, fault 0x8130: communication was lost"));
}

TEST_CASE("fault: a refused connection names the place and what it means") {
  SessionSetup setup;
  {
    DriveBench bench;
    setup = bench.setup();
  }
  DriveClient client(setup);
  CHECK(client.failure() ==
        "127.0.0.1:" + std::to_string(setup.endpoint.port) + " unit 1: the connection is refused: nothing listens there");
}

TEST_CASE("fault: a wrong unit id is refused and no motor moves") {
  for (const bool is_tcp : {true, false}) {
    DriveBench bench(is_tcp, 7);
    DriveClient client(bench.setup());
    CHECK_FALSE(client.open());
    CHECK_THAT(client.failure(), Contains(is_tcp ? "exception 11 (gateway target device failed to respond)" : "no whole answer"));
    CHECK_FALSE(bench.output_stage_on());
    CHECK(bench.server().with_drive([](auto& d) { return d.read(0x10); }) == 0);
  }
}

TEST_CASE("fault: another device than that of the register map is refused and no motor moves") {
  DriveBench bench;
  bench.server().with_drive([](auto& d) { d.set_product(999); });
  DriveClient client(bench.setup());
  CHECK_THAT(client.failure(), Contains("another device than that of simulated_drive.yaml: product (holding register 0x0001) is "
                                        "999, the map says 402"));
  CHECK(bench.server().with_drive([](auto& d) { return d.read(0x10); }) == 0);
}

TEST_CASE("fault: a register map with an address that the device does not have is refused and no motor moves") {
  DriveBench bench;
  SessionSetup setup = bench.setup();
  setup.map.registers[setup.map.find("speed").value()].address = 0x300;
  DriveClient client(setup);
  CHECK_THAT(client.failure(),
             Contains("reading holding registers 0x0300 to 0x0301: the device answers with exception 2 (illegal data address)"));
  setup = bench.setup();
  setup.map.registers[setup.map.find("statusword").value()].address = 0x01;  // product: 402 is no statusword
  DriveClient other(setup);
  CHECK_THAT(other.failure(), Contains("statusword 0x0192 is no state of CiA 402: the register map does not fit the device"));
  CHECK_FALSE(bench.output_stage_on());
}

TEST_CASE("fault: a drive whose watchdog does not take its value is not enabled") {
  DriveBench bench;
  bench.server().with_drive([](auto& d) { d.stick_watchdog(0); });
  DriveClient client(bench.setup());
  CHECK_THAT(client.failure(),
             Contains("the drive's communication watchdog: watchdog (holding register 0x0012) reads 0 ms where 800 ms "
                      "is needed; the drive is not enabled"));
  CHECK_FALSE(bench.output_stage_on());
}

TEST_CASE("fault: a watchdog register that would become 0 by rounding is refused and the drive is not enabled") {
  DriveBench bench;
  SessionSetup setup = bench.setup();
  setup.map.registers[setup.map.find("watchdog").value()].scale = 5000.0;
  DriveClient client(setup);
  CHECK_THAT(client.failure(), Contains("watchdog (holding register 0x0012) can't hold 800 ms: it would be 0"));
  CHECK_FALSE(bench.output_stage_on());
}

TEST_CASE("fault: a drive that somebody else runs is left alone") {
  DriveBench bench;
  DriveClient first(bench.setup());
  REQUIRE(first.run_up() == "");
  DriveClient second(bench.setup());
  CHECK_THAT(second.failure(), Contains("the drive is in operation_enabled already: another client or its panel drives it"));
  CHECK(bench.enabled());
  CHECK(first.poller().stop().confirmed);
}

TEST_CASE("fault: a drive that does not come to operation_enabled is given up with its state") {
  DriveBench bench;
  SessionSetup setup = bench.setup();
  setup.map.setup.clear();  // without its mode the simulated drive stays in switched_on
  setup.enable_time_s = 0.2;
  DriveClient client(setup);
  CHECK_THAT(client.failure(), Contains("the drive is not enabled after 0.2 s: it is in switched_on (statusword 0x0633)"));
  CHECK(bench.stops());
}
