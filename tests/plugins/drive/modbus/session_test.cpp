#include <algorithm>

#include "catch.hpp"
#include "drive_bench.hpp"
#include "trace_import.hpp"

using bodeflow::test::DriveBench;
using bodeflow::test::DriveClient;
using namespace bodeflow::drive::modbus;
using Catch::Matchers::Contains;

namespace {

void run_and_stop(bool is_tcp) {
  DriveBench bench(is_tcp);
  DriveClient client(bench.setup());
  REQUIRE(client.run_up() == "");
  CHECK(bench.enabled());
  CHECK(bench.speed() == Approx(300).margin(40));                                 // it has just come there
  CHECK(bench.server().with_drive([](auto& d) { return d.read(0x12); }) == 800);  // the watchdog, ms
  const Stopped stopped = client.poller().stop();
  CHECK(stopped.confirmed);
  CHECK(stopped.text == "the drive was stopped and confirms switch_on_disabled");
  CHECK_FALSE(bench.output_stage_on());
  CHECK(std::abs(bench.speed()) < 5.0);
  CHECK(bench.fault_code() == 0);
}

}  // namespace

TEST_CASE("a drive on TCP is enabled and runs and stands still with its output stage off when the client ends") {
  run_and_stop(true);
}

TEST_CASE("a drive on a serial line is enabled and runs and stands still with its output stage off when the client ends") {
  run_and_stop(false);
}

TEST_CASE("quick stop and disabling end with the output stage off and a later enabling runs the motor again") {
  DriveBench bench;
  DriveClient client(bench.setup());
  REQUIRE(client.run_up() == "");
  const auto is = [](DriveState state) { return [state](const Polled& p) { return p.state == state; }; };
  CHECK(client.run_until(is(DriveState::switch_on_disabled), 300, DriveCommand::quick_stop) == "");
  CHECK_FALSE(bench.output_stage_on());
  CHECK(std::abs(bench.speed()) < 5.0);
  CHECK(client.run_until(is(DriveState::operation_enabled), 300) == "");
  CHECK(client.run_until(is(DriveState::ready_to_switch_on), 300, DriveCommand::disable) == "");
  CHECK_FALSE(bench.output_stage_on());
  CHECK(client.run_until(is(DriveState::operation_enabled), 300) == "");
}

TEST_CASE("a fault at the start is refused or reset as the setup says") {
  DriveBench bench;
  bench.server().with_drive([](auto& d) { d.trip(0x3210); });
  {
    DriveClient client(bench.setup());
    CHECK_THAT(client.failure(),
               Contains("the drive is in fault 0x3210: DC link over-voltage; allowed: none, or reset_faults: true"));
  }
  CHECK(bench.fault_code() == 0x3210);
  SessionSetup setup = bench.setup();
  setup.reset_faults = true;
  DriveClient client(setup);
  CHECK(client.run_up() == "");
  CHECK(bench.fault_code() == 0);
}

TEST_CASE("nothing is written to a drive that is only looked at") {
  DriveBench bench;
  SessionSetup setup = bench.setup();
  setup.drives = false;
  setup.set_points.clear();
  bench.server().with_drive([](auto& d) { d.show_speed(77.7); });
  DriveClient client(setup);
  CHECK(client.run_until([](const Polled& p) { return p.measurements[0] > 77.0; }) == "");
  CHECK(client.poller().stop().text == "nothing was written to the drive");
  CHECK(bench.server().with_drive([](auto& d) { return d.read(0x12); }) == 0);
}

TEST_CASE("a drive that answers slowly costs late samples but neither the loop nor the run") {
  DriveBench bench;
  DriveClient client(bench.setup());
  REQUIRE(client.run_up() == "");
  bench.server().disturb(bodeflow::drive::simulated::Disturbance::slow, 8);
  const std::int64_t late = client.poller().counts().late;
  int samples = 0;
  CHECK(client.run_until([&](const Polled&) { return ++samples == 20; }, 300.0) == "");
  // A sample is late when it comes while a cycle waits for its answer: the loop went on meanwhile.
  CHECK(client.poller().counts().late > late + 5);
}

TEST_CASE("a damaged answer is asked for again when retries allow it") {
  for (const bool is_tcp : {true, false}) {
    DriveBench bench(is_tcp);
    SessionSetup setup = bench.setup();
    setup.endpoint.retries = 1;
    DriveClient client(setup);
    REQUIRE(client.run_up() == "");
    bench.server().disturb(bodeflow::drive::simulated::Disturbance::damaged, 1);
    int samples = 0;
    CHECK(client.run_until([&](const Polled&) { return ++samples == 40; }, 300.0) == "");
    CHECK(client.poller().counts().retried == 1);
    CHECK(bench.enabled());
  }
}

TEST_CASE("the trace buffer of a drive is fetched with its units once it is full") {
  DriveBench bench;
  SessionSetup setup = bench.setup();
  setup.arm_trace = true;
  {
    DriveClient client(setup);
    REQUIRE(client.run_up() == "");
    auto early = Link::open(setup.endpoint).value();
    CHECK_THAT(import_trace(*early, setup.map).error().text,
               Contains("the trace is not complete: trace_done (holding register 0x0051) is 0, needed: 1"));
  }
  REQUIRE(DriveBench::wait([&] { return bench.server().with_drive([](auto& d) { return d.read(0x51) == 1; }); }));
  auto link = Link::open(setup.endpoint).value();
  const auto trace = import_trace(*link, setup.map);
  REQUIRE(trace);
  REQUIRE(trace->size() == 2);
  REQUIRE(trace->at(0).size() == 1000);
  CHECK(std::abs(trace->at(0)[0]) < 5.0);
  CHECK(*std::max_element(trace->at(0).begin(), trace->at(0).end()) == Approx(305).margin(15));
  CHECK(*std::max_element(trace->at(1).begin(), trace->at(1).end()) == Approx(5).margin(2));  // 157 rad/s^2 x 0.031 kg m^2
}
