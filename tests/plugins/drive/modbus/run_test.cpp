// Whole runs, as users start them, against a simulated drive of this process: whatever ends them, the motor stands.
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "drive_bench.hpp"
#include "system/command.hpp"

using bodeflow::test::DriveBench;
using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

/// A graph that runs the drive up to 600 rpm; `more` replaces what follows the drive's first parameters.
std::string graph(const DriveBench& bench, const std::string& run, const std::string& reference, const std::string& more) {
  const auto endpoint = bench.setup().endpoint;
  const std::string place = endpoint.tcp ? "port: " + std::to_string(endpoint.port)
                                         : "connection: rtu, baud: 115200, parity: none, device: " + endpoint.device;
  return "bodeflow: 1\ntitle: test\nrun: {" + run + "}\nblocks:\n  reference: {" + reference +
         "}\n  drive: {block: drive.modbus, map: " BODEFLOW_SOURCE_DIR "/graphs/drive/maps/simulated_drive.yaml, " + place +
         ", poll_rate: 100 Hz, timeout: 250 ms, watchdog: 800 ms, set_points: [target_speed], measurements: [speed], " + more +
         "}\nconnections:\n  - reference -> drive.set_points\nrecord: [drive.measurements, drive.status]\n";
}

const std::string kPaced = "clock: realtime, chunk: 1, duration: 1 s";
const std::string kLong = "clock: realtime, chunk: 1, duration: 60 s";
const std::string kRamp = "block: generators.ramp, sample_rate: 100 Hz, time: 0.3 s, slope: 1000, duration: 0.4 s, unit: rpm";
const std::string kStop = "stop_time: 2 s";

/// `bodeflow run` in a process of its own.
class Started {
 public:
  Started(const Folder& folder, const std::string& text) {
    const std::string file = folder.write("graph.yaml", text).string(), out = (folder.path() / "out").string(),
                      log = (folder.path() / "log").string();
    pid_ = ::fork();
    if (pid_ == 0) {
      [[maybe_unused]] const FILE* to = std::freopen(log.c_str(), "w", stderr);
      [[maybe_unused]] const FILE* none = std::freopen("/dev/null", "w", stdout);
      ::execl(BODEFLOW_BUILD_DIR "/bin/bodeflow", "bodeflow", "run", file.c_str(), "--out", out.c_str(), nullptr);
      ::_exit(127);
    }
  }
  /// The exit code, 128 + signal for a process that was killed.
  int end(int signal) {
    ::kill(pid_, signal);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  pid_t pid_ = 0;
};

}  // namespace

TEST_CASE("run: a graph drives a motor by Modbus and leaves it standing with its output stage off") {
  for (const bool is_tcp : {true, false}) {
    DriveBench bench(is_tcp);
    const Folder folder;
    std::string text = graph(bench, kPaced, kRamp, kStop);
    const int rate_hz = is_tcp ? 100 : 50;  // the line takes 16 ms a cycle
    if (!is_tcp) {
      for (std::size_t at = 0; (at = text.find("100 Hz", at)) != std::string::npos;) text.replace(at, 6, "50 Hz");
    }
    folder.write("graph.yaml", text);
    const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
    INFO(ended.err);
    REQUIRE(ended.exit_code == 0);
    CHECK(bench.stops());
    CHECK(bench.fault_code() == 0);
    const Json report = Json::parse(folder.read("out/result.json"))["results"]["drive"]["attributes"];
    CHECK(report["stopped"] == true);
    CHECK(report["stop"] == "the drive was stopped and confirms switch_on_disabled");
    CHECK(report["cycles"].get<int>() + report["late"].get<int>() >= rate_hz - 1);
  }
}

TEST_CASE("run: an interrupt stops the motor before the program ends") {
  DriveBench bench;
  const Folder folder;
  Started run(folder, graph(bench, kLong, kRamp, kStop));
  REQUIRE(DriveBench::wait([&] { return bench.speed() > 350; }, 20));
  CHECK(run.end(SIGINT) == 130);
  CHECK_FALSE(bench.output_stage_on());
  CHECK(std::abs(bench.speed()) < 5.0);
  CHECK(bench.fault_code() == 0);
}

TEST_CASE("run: a program that is killed leaves the motor stopped by the drive's watchdog") {
  DriveBench bench;
  const Folder folder;
  Started run(folder, graph(bench, kLong, kRamp, kStop));
  REQUIRE(DriveBench::wait([&] { return bench.speed() > 350; }, 20));
  CHECK(run.end(SIGKILL) == 128 + SIGKILL);
  CHECK(bench.output_stage_on());
  CHECK(bench.stops());
  CHECK(bench.fault_code() == 0x8130);
}

TEST_CASE("run: a lost connection ends the run with its reason and the motor stands") {
  DriveBench bench;
  const Folder folder;
  Started run(folder, graph(bench, kLong, kRamp, kStop));
  REQUIRE(DriveBench::wait([&] { return bench.speed() > 350; }, 20));
  bench.server().disturb(bodeflow::drive::simulated::Disturbance::gone);
  CHECK(run.end(0) != 0);
  CHECK_THAT(folder.read("log"),
             Contains("the connection was reset by the device") && Contains("its own watchdog of 800 ms is left to stop it"));
  CHECK(bench.stops());
  CHECK(bench.fault_code() == 0x8130);
  CHECK(Json::parse(folder.read("out/result.json"))["status"] == "failed");
}

TEST_CASE("run: a set point beyond its limits never reaches the drive and stops the motor") {
  DriveBench bench;
  const Folder folder;
  const std::string steep = "block: generators.ramp, sample_rate: 100 Hz, time: 0.3 s, slope: 4000, unit: rpm";
  folder.write("graph.yaml", graph(bench, kLong, steep, kStop));
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  CHECK(ended.exit_code != 0);
  CHECK_THAT(ended.err, Contains("limit violated: set point 'target_speed' is 1520 rpm at sample 69, allowed: -1500 to 1500 rpm; "
                                 "the drive was stopped and confirms switch_on_disabled"));
  CHECK_FALSE(bench.output_stage_on());
  CHECK(std::abs(bench.speed()) < 5.0);
  CHECK(bench.fault_code() == 0);
}

TEST_CASE(
    "run: a limit of the graph that is violated stops the motor, of a set point from its sample on, of a speed when it is read") {
  struct Case {
    const char* limit;
    const char* said;
  };
  for (const Case& one :
       {Case{"{signal: drive.set_points, max: 355 rpm, on_violation: stop}",
             "limit violated: drive.set_points is 360 rpm at sample 67 (0.67 s), allowed: at most 355 rpm"},
        Case{"{signal: drive.set_points, rate: 900 rpm/s, on_violation: stop}",
             "limit violated: drive.set_points changes by 1000 rpm/s at "
             "sample 32 (0.32 s), allowed: changes of at most 900 "
             "rpm/s"},
        Case{"{signal: drive.feedback, max: 300 rpm, time: 10 ms}", "limit violated: drive.feedback is 30"},
        Case{"{signal: drive.feedback, rate: 10 rpm/s, time: 10 ms}", "limit violated: drive.feedback changes by "}}) {
    DriveBench bench;
    const Folder folder;
    folder.write("graph.yaml", graph(bench, kLong, kRamp, kStop) + "limits:\n  - " + one.limit + "\n");
    const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
    CHECK(ended.exit_code == 7);
    CHECK_THAT(ended.err, Contains(one.said));
    CHECK_FALSE(bench.output_stage_on());
    CHECK(std::abs(bench.speed()) < 5.0);
    CHECK(bench.fault_code() == 0);
    CHECK(Json::parse(folder.read("out/manifest.json"))["status"] == "limit");
  }
}

TEST_CASE("run: a set point that is held within its limits turns the motor no faster") {
  DriveBench bench;
  const Folder folder;
  folder.write("graph.yaml", graph(bench, kPaced, kRamp, kStop) +
                                 "limits:\n  - {signal: drive.set_points, min: 0 rpm, max: 205 rpm}\n"
                                 "  - {signal: drive.measurements, channel: speed, min: -100 rpm, max: 300 rpm}\n");
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK_THAT(ended.err, Contains("drive.set_points is 210 rpm at sample 52 (0.52 s), allowed: 0 to 205 rpm; it is held within"));
  const Json limits = Json::parse(folder.read("out/manifest.json"))["phases"][0]["limits"];
  CHECK(limits[0]["highest"] == 400.0);
  CHECK(limits[1]["violations"] == 0);
  CHECK(limits[1]["highest"].get<double>() > 150.0);
  CHECK(bench.stops());
}

TEST_CASE("run: a command that is scheduled stops the motor within the run") {
  DriveBench bench;
  const Folder folder;
  folder.write("graph.yaml",
               graph(bench, kPaced, kRamp, kStop) + "schedule:\n  - {at: 0.6 s, block: drive, set: {command: quick_stop}}\n");
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK_FALSE(bench.output_stage_on());
  CHECK(std::abs(bench.speed()) < 5.0);
}

TEST_CASE("run: check refuses a loop that is faster than the poll rate and a run that is not paced is refused") {
  DriveBench bench;
  const Folder folder;
  const std::string fast = "block: generators.ramp, sample_rate: 1 kHz, slope: 100, unit: rpm";
  folder.write("fast.yaml", graph(bench, kPaced, fast, kStop));
  const auto checked = run_bodeflow({"check", "fast.yaml"}, folder.path());
  CHECK(checked.exit_code == 3);
  CHECK_THAT(checked.err,
             Contains("'set_points' has 1000 samples/s, the drive is polled 100 times a second (poll_rate): the loop "
                      "is faster than the drive takes set points"));
  folder.write("simulated.yaml", graph(bench, "clock: simulated, duration: 1 s", kRamp, kStop));
  const auto simulated = run_bodeflow({"run", "simulated.yaml", "--out", "out"}, folder.path());
  CHECK(simulated.exit_code != 0);
  CHECK_THAT(simulated.err, Contains("found run: {clock: simulated}, allowed: run: {clock: realtime, chunk: 1}"));
  folder.write("chunk.yaml", graph(bench, "clock: realtime, duration: 1 s", kRamp, kStop));
  const auto chunk = run_bodeflow({"run", "chunk.yaml", "--out", "out2"}, folder.path());
  CHECK(chunk.exit_code != 0);
  CHECK_THAT(chunk.err, Contains("samples at once, which would reach the drive in a burst"));
  CHECK_FALSE(bench.output_stage_on());
  CHECK(bench.server().with_drive([](auto& d) { return d.read(0x10); }) == 0);
}

TEST_CASE("run: the speed loop of the graphs runs as it stands and fetches the drive's trace", "[long]") {
  DriveBench bench;
  const Folder folder;
  const auto ended = run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/drive/modbus_speed_loop.yaml", "--out", "out", "--set",
                                   "port=" + std::to_string(bench.server().port())},
                                  folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const Json results = Json::parse(folder.read("out/result.json"))["results"];
  const Json first = results["loop.response"]["arrays"]["response"]["data"][0];
  CHECK(std::hypot(first[0].get<double>(), first[1].get<double>()) == Approx(1.0).margin(0.05));
  const std::string trace = folder.read("out/trace.csv");
  CHECK(std::count(trace.begin(), trace.end(), '\n') == 1001);
  CHECK(bench.stops());
  CHECK(bench.fault_code() == 0);
}
