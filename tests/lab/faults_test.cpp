// Faults of a lab in the middle of a run: what is lost, what goes on, and what is said of it.
#include <sys/mount.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "catch.hpp"
#include "lab.hpp"
#include "processes_of.hpp"

using namespace bodeflow::test;
using nlohmann::json;

namespace {

namespace fs = std::filesystem;

const std::string kLoop = closed_loop("clock: realtime, duration: 4 s, seed: 1");
const std::string kGraphs = BODEFLOW_SOURCE_DIR "/graphs/lab/";

/// The motor turns on the bench and its speed is recorded on another host, whether the process that started the run lives or not.
const char* const kGoesOn = R"(bodeflow: 1
run: {clock: realtime, duration: 4 s, seed: 1, tolerance: 1.5 s, launcher_lost: continue}
blocks:
  excitation: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}
  motor: {block: plants.linear, numerator: [1], denominator: [0.1, 1]}
  speed: {block: filters.gain, gain: 2}
  reference: {block: generators.noise, sample_rate: 1 kHz, std: 1}
connections: [excitation -> motor -> speed]
record: [motor.out, speed.out, reference.out]
hosts: {bench: [excitation, motor], controller: [speed]}
)";

/// A file system of that size in memory, as long as the object lives.
class SmallDisk {
 public:
  SmallDisk(std::string folder, const std::string& size) : folder_(std::move(folder)) {
    fs::create_directories(folder_);
    there_ = mount("tmpfs", folder_.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  ~SmallDisk() {
    if (there_) umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  bool there() const { return there_; }

 private:
  std::string folder_;
  bool there_ = false;
};

}  // namespace

TEST_CASE("lab: two runs of one graph at the same time on the same agents do not touch each other") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  const json hashes = lab.hashes_here(text_of(kGraphs + "closed_loop.yaml"));
  Process first(lab.run(kGraphs + "closed_loop.yaml", "first"));
  Process second(lab.run(kGraphs + "closed_loop.yaml", "second"));
  lab.require_complete(first, "first", hashes);
  lab.require_complete(second, "second", hashes);
}

TEST_CASE("lab: a full disk of one host ends the run by name and the others keep what they recorded") {
  TestLab lab;
  const SmallDisk disk(lab.path("agent_bench"), "24m");
  if (!disk.there()) {
    WARN("skipped: mounting file systems is not permitted");
    return;
  }
  lab.agent("bench");
  lab.folder().write("full.yaml", R"(bodeflow: 1
run: {clock: simulated, duration: 1000 s, seed: 1}
blocks:
  excitation: {block: generators.noise, sample_rate: 10 kHz, std: 1}
  motor: {block: plants.linear, domain: discrete, numerator: [1], denominator: [1, -0.5]}
  gain: {block: filters.gain, gain: 2}
  slow: {block: filters.decimate, factor: 10}
connections: [excitation -> motor -> gain -> slow]
record: [motor.out, slow.out]
hosts: {bench: [motor]}
)");
  Process run(lab.run(lab.path("full.yaml"), "out"));
  const int code = run.wait();
  INFO(run.output());
  CHECK(code == 1);
  CHECK(run.output().find("host 'bench': ") != std::string::npos);
  CHECK(run.output().find("No space left on device") != std::string::npos);
  CHECK(lab.manifest("out")["status"] == "failed");
  CHECK(lab.hashes("out").contains("slow.out"));
}

TEST_CASE("lab: clocks that are two seconds apart are told and change nothing") {
  TestLab lab;
  lab.agent("bench", {}, {"env", "ASAN_OPTIONS=verify_asan_link_order=0", "LD_PRELOAD=" LATE_CLOCK});
  lab.agent("controller");
  Process hosts({BODEFLOW_COMMAND, "hosts", "--json", "--wait", "1", "--loopback", "--domain", std::to_string(test_domain())});
  REQUIRE(hosts.wait() == 0);
  const json list = json::parse(hosts.output());
  REQUIRE(list.size() == 2);
  const double bench = list[0]["clock_offset_s"], controller = list[1]["clock_offset_s"];
  CHECK(std::abs(bench - 2.0) <= list[0]["clock_uncertainty_s"].get<double>());
  CHECK(std::abs(controller) <= list[1]["clock_uncertainty_s"].get<double>());

  const json hashes = lab.hashes_here(text_of(kGraphs + "closed_loop.yaml"));
  Process run(lab.run(kGraphs + "closed_loop.yaml", "hosts"));
  lab.require_complete(run, "hosts", hashes);
}

TEST_CASE("lab: hosts end their phase and keep their files without a launcher where the graph says so") {
  TestLab lab;
  Process& bench = lab.agent("bench");
  Process& controller = lab.agent("controller");
  const auto graph = lab.folder().write("goes_on.yaml", kGoesOn).string();
  const json hashes = lab.hashes_here(kGoesOn);
  Process run(lab.run(graph, "out"));
  REQUIRE(lab.has_graph("bench"));
  REQUIRE(lab.has_graph("controller"));
  sleep_s(2.0);
  for (const int launcher : processes_with({"--out", lab.path("out")})) kill(launcher, SIGKILL);
  for (Process* agent : {&bench, &controller}) {
    REQUIRE(agent->prints("nothing was heard of the launcher for 1.5 s; what was recorded is in"));
    REQUIRE(agent->prints("ends with exit code 1"));
  }
  const auto kept = [&](const std::string& host, const std::string& stream) {
    for (const auto& entry : fs::directory_iterator(lab.path("agent_" + host))) {
      const json manifest = lab.manifest("agent_" + host + "/" + entry.path().filename().string());
      CHECK(manifest["status"] == "complete");
      CHECK(manifest["hashes"][stream] == hashes[stream]);
    }
  };
  kept("bench", "motor.out");
  kept("controller", "speed.out");
}

TEST_CASE("lab: an agent that was killed and started again serves the next run") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  const json hashes = lab.hashes_here(text_of(kGraphs + "closed_loop.yaml"));
  lab.crash("bench");
  lab.agent("bench");
  Process run(lab.run(kGraphs + "closed_loop.yaml", "hosts"));
  lab.require_complete(run, "hosts", hashes);
}

TEST_CASE("lab: a connection that stands still is told within a second and a half and goes on afterwards") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  const auto graph = lab.folder().write("loop.yaml", kLoop).string();
  const json hashes = lab.hashes_here(kLoop);
  Process run(lab.run(graph, "hosts"));
  const int part = lab.part_of("bench");
  REQUIRE(part > 0);
  REQUIRE(lab.has_graph("bench"));
  sleep_s(2.0);
  const auto begin = Clock::now();
  kill(part, SIGSTOP);
  const bool told = run.prints("stands still", 3.0);
  const double after = since_s(begin);
  sleep_s(3.0 - after);
  kill(part, SIGCONT);
  INFO(run.output());
  CHECK(told);
  CHECK(after < 1.3);
  lab.require_complete(run, "hosts", hashes);
}

TEST_CASE("lab: top shows every host and connection of a run") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  Process run(lab.run(lab.folder().write("loop.yaml", kLoop).string(), "out"));
  REQUIRE(lab.has_graph("controller"));
  sleep_s(1.5);
  const json runs = lab.top();
  INFO(runs.dump(1));
  REQUIRE(runs.size() == 1);
  REQUIRE(runs[0]["hosts"].size() == 3);
  std::vector<std::string> seen;
  for (const json& host : runs[0]["hosts"]) {
    CHECK(host["time_s"].get<double>() > 0.0);
    CHECK(host["time_s"].get<double>() < 4.0);
    CHECK(host["rate"].get<double>() == Approx(1.0).margin(0.2));
    CHECK(host["pacing"]["clock"] == "realtime");
    CHECK(host["pacing"]["chunks"].get<double>() > 10.0);
    CHECK(host["pacing"]["median_s"].get<double>() <= host["pacing"]["max_s"].get<double>());
    for (const json& link : host["links"]) {
      seen.push_back(host["host"].get<std::string>() + (link["sends"] == true ? " > " : " < ") +
                     link["other"].get<std::string>());
      CHECK(link["matched"] == true);
      CHECK(link["messages"].get<double>() > 10.0);
      CHECK(link["samples"].get<double>() > 10.0);
      CHECK(link["bytes"].get<double>() >= 8.0 * link["samples"].get<double>());
      CHECK(link["gaps"] == 0);
      CHECK(link["reconnects"] == 0);
      CHECK(link["latency_p50_s"].get<double>() <= link["latency_p99_s"].get<double>());
      CHECK(link["latency_p99_s"].get<double>() < 0.5);
      CHECK(link["stalled_s"].get<double>() < 0.5);
    }
  }
  std::sort(seen.begin(), seen.end());
  CHECK(seen == std::vector<std::string>{" < bench", " > controller", "bench < controller", "bench > ", "bench > controller",
                                         "controller < ", "controller < bench", "controller > bench"});
  CHECK(run.wait() == 0);
}

TEST_CASE("lab: nothing is left in shared memory after the clean end of a run and its agents") {
  TestLab lab;
  Process& bench = lab.agent("bench");
  Process& controller = lab.agent("controller");
  Process run(lab.run(lab.folder().write("loop.yaml", kLoop).string(), "out"));
  REQUIRE(lab.part_of("controller") > 0);
  sleep_s(2.0);
  std::vector<std::string> segments;
  for (const int process : processes_with({lab.folder().path().string()}))
    for (const std::string& name : bodeflow::test::shared_memory_of(process)) segments.push_back(name);
  REQUIRE_FALSE(segments.empty());
  REQUIRE(run.wait() == 0);
  bench.interrupt();
  controller.interrupt();
  CHECK(bench.wait() == 0);
  CHECK(controller.wait() == 0);
  for (const std::string& name : segments) {
    INFO(name);
    CHECK_FALSE(fs::exists(name));
  }
}
