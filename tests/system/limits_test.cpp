// Limits of a graph and dry runs, as users meet them.
#include <nlohmann/json.hpp>
#include <sstream>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;
using Json = nlohmann::json;

namespace {

/// A ramp from 0 by 1 V a millisecond into an amplifier; `limits` in line 9.
std::string amplifier(const std::string& limits, const std::string& run = "duration: 100 ms") {
  return "bodeflow: 1\nrun: {" + run +
         "}\nblocks:\n"
         "  ramp: {block: generators.ramp, sample_rate: 1 kHz, slope: 1000, unit: V}\n"
         "  amplifier: {block: filters.gain, gain: 10}\n"
         "connections: [ramp -> amplifier]\n"
         "record: all\n"
         "limits:\n" +
         limits;
}

std::vector<Json> events(const Folder& folder, const std::string& what) {
  std::vector<Json> found;
  std::istringstream lines(folder.read("out/events.jsonl"));
  for (std::string line; std::getline(lines, line);)
    if (Json event = Json::parse(line); event["event"] == what) found.push_back(std::move(event));
  return found;
}

}  // namespace

TEST_CASE("limits: a run that is held within them is complete, warns, counts, and can be repeated bit for bit") {
  const Folder folder;
  folder.write("graph.yaml", amplifier("  - {signal: amplifier.in, max: 50.5 V, rate: 2 V/ms}\n"));
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK_THAT(ended.err,
             Contains("amplifier.in is 51 V at sample 51 (0.051 s), allowed: at most 50.5 V, changes of at most 2000 V/s; "
                      "it is held within"));
  CHECK_THAT(ended.err, Contains("amplifier.in: 49 of 100 samples were held within at most 50.5 V"));
  const auto told = events(folder, "limit violated");
  REQUIRE(told.size() == 1);
  CHECK(told[0]["signal"] == "amplifier.in");
  CHECK(told[0]["bound"] == "max");
  CHECK(told[0]["position"] == 51);
  CHECK(told[0]["value"] == 51.0);
  CHECK(told[0]["on_violation"] == "clamp");
  const Json limit = Json::parse(folder.read("out/manifest.json"))["phases"][0]["limits"][0];
  CHECK(limit["violations"] == 49);
  CHECK(limit["samples"] == 100);
  CHECK(limit["highest"] == 99.0);
  CHECK(limit["first"]["position"] == 51);
  CHECK(limit["ended_run"] == false);
  const auto again = run_bodeflow({"rerun", "out", "--out", "again"}, folder.path());
  CHECK(again.exit_code == 0);
  CHECK_THAT(again.out, Contains("all identical bit for bit"));
}

TEST_CASE("limits: one that stops the run ends it with exit code 7, its reason, and what was recorded") {
  const Folder folder;
  folder.write("graph.yaml",
               amplifier("  - {signal: amplifier.out, max: 400 V, time: 20 ms}\n", "duration: 100 ms, latency: 20 ms"));
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out", "--json"}, folder.path());
  CHECK(ended.exit_code == 7);
  const std::string reason =
      "limit violated: amplifier.out is 410 V at sample 41 (0.041 s), allowed: at most 400 V; the run was ended";
  CHECK_THAT(ended.err, Contains(reason));
  CHECK(Json::parse(ended.out)["status"] == "limit");
  const Json manifest = Json::parse(folder.read("out/manifest.json"));
  CHECK(manifest["status"] == "limit");
  CHECK(manifest["reason"] == reason);
  CHECK(manifest["phases"][0]["limits"][0]["ended_run"] == true);
  CHECK(manifest["phases"][0]["limits"][0]["latency_samples"] == 20);
  CHECK(events(folder, "limit violated").size() == 1);
  CHECK(std::filesystem::exists(folder.path() / "out" / "data.h5"));
  CHECK(manifest["hashes"].contains("amplifier.out"));
}

TEST_CASE("limits: check refuses a time that the plan does not keep, plan prints the latency of each limit") {
  const Folder folder;
  folder.write("slow.yaml", amplifier("  - {signal: amplifier.out, max: 400 V, time: 5 ms}\n"));
  for (const char* command : {"check", "run"}) {
    const auto refused = run_bodeflow({command, "slow.yaml"}, folder.path());
    CHECK(refused.exit_code == 3);
    CHECK_THAT(refused.err, Contains("slow.yaml:9:47: limits: 'amplifier.out' must act within 5 ms, the plan needs 1.024 s"));
  }
  const auto planned = run_bodeflow({"plan", "slow.yaml", "--set", "run.latency=5 ms"}, folder.path());
  REQUIRE(planned.exit_code == 0);
  CHECK_THAT(planned.out, Contains("limits:\n  amplifier.out: at most 400 V; stop, within 5 samples (5 ms)\n"));
}

TEST_CASE("limits: a sweep runs with them and ends by them") {
  const Folder folder;
  const std::string graph =
      "bodeflow: 1\nphases:\n  - name: gains\n    run: {duration: 1 s}\n    blocks:\n"
      "      tone: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}\n"
      "      gain: {block: filters.gain}\n"
      "      dft: {block: spectrum.averaging_dft, period: 100, form: known_input, lines: {first: 1, last: 1}}\n"
      "    connections: [tone -> gain -> dft.output, tone -> dft.input]\n"
      "    limits:\n      - {signal: gain.out, max: 5, min: -5}\n"
      "    sweep: {gain.gain: [1, 4, 7]}\n";
  folder.write("graph.yaml", graph);
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  CHECK(ended.exit_code == 7);
  CHECK_THAT(ended.err, Contains("run 2 of the sweep failed") && Contains("limit violated: gain.out is"));
  const auto fine =
      run_bodeflow({"run", "graph.yaml", "--out", "fine", "--set", "gains.limits=[{signal: gain.out, max: 8}]"}, folder.path());
  INFO(fine.err);
  CHECK(fine.exit_code == 0);
}

TEST_CASE("limits: a sweep whose runs were held within them says so") {
  const Folder folder;
  folder.write("graph.yaml",
               "bodeflow: 1\nphases:\n  - name: gains\n    run: {duration: 1 s}\n    blocks:\n"
               "      tone: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}\n"
               "      gain: {block: filters.gain}\n"
               "      dft: {block: spectrum.averaging_dft, period: 100, form: known_input, lines: {first: 1, last: 1}}\n"
               "    connections: [tone -> gain -> dft.output, tone -> dft.input]\n"
               "    limits: [{signal: dft.output, max: 5}, {signal: gain.out, min: -100}]\n"
               "    sweep: {gain.gain: [1, 7, 10]}\n");
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  REQUIRE(ended.exit_code == 0);
  CHECK_THAT(ended.err,
             Contains("dft.output: in 2 of the 3 runs of the sweep samples were held within at most 5; in run 1 it was"));
  const auto told = events(folder, "limit violated");
  REQUIRE(told.size() == 1);
  CHECK(told[0]["signal"] == "dft.output");
  CHECK(told[0]["run"] == 1);
  CHECK(told[0]["runs"] == 2);
  CHECK(told[0]["bound"] == "max");
}

TEST_CASE("dry run: a graph without devices says so, with the limits of its signals") {
  const Folder folder;
  folder.write("graph.yaml", amplifier("  - {signal: amplifier.in, max: 50 V}\n"));
  const auto ended = run_bodeflow({"run", "graph.yaml", "--dry-run", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK_THAT(ended.out, Contains("No devices, no network: nothing outside is moved.") &&
                            Contains("amplifier.in: at most 50 V; clamp, from the same sample on") &&
                            Contains("Nothing was run."));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_CASE("dry run: shows a device, its signals, limits, and the largest excitation where it can be known") {
  const Folder folder;
  const std::string drive = "  drive: {block: drive.modbus, map: " BODEFLOW_SOURCE_DIR
                            "/graphs/drive/maps/simulated_drive.yaml, host: 192.0.2.1, "
                            "poll_rate: 100 Hz, set_points: [target_speed], measurements: [speed]}\n";
  folder.write("open.yaml",
               "bodeflow: 1\nrun: {clock: realtime, chunk: 1, duration: 3 s}\nblocks:\n"
               "  ramp: {block: generators.ramp, sample_rate: 100 Hz, time: 0.5 s, slope: 500, duration: 2 s, unit: rpm}\n" +
                   drive +
                   "connections: [ramp -> drive.set_points]\n"
                   "limits:\n"
                   "  - {signal: drive.set_points, min: 0 rpm, max: 1200 rpm, rate: 1000 rpm/s}\n"
                   "  - {signal: drive.measurements, max: 1300 rpm, time: 20 ms}\n");
  const auto open = run_bodeflow({"run", "open.yaml", "--dry-run"}, folder.path());
  INFO(open.out << open.err);
  REQUIRE(open.exit_code == 0);
  CHECK_THAT(open.out, Contains("drive: drive.modbus") && Contains("host 192.0.2.1") && Contains("poll_rate 100 Hz"));
  CHECK_THAT(open.out, Contains("limit: 0 to 1200 rpm, changes of at most 1000 rpm/s; clamp, from the same sample"));
  CHECK_THAT(open.out, Contains("limit: at most 1300 rpm; stop, within 1 sample (10 ms)"));
  CHECK_THAT(open.out, Contains("largest excitation: 0 to 1000 rpm, largest at 2.5 s, changes of up to 500 rpm/s"));

  const auto step = run_bodeflow({"run", "open.yaml", "--dry-run", "--set", "ramp.offset=100"}, folder.path());
  CHECK_THAT(step.out, Contains("changes of up to 10000 rpm/s"));  // the drive begins at 0

  const auto json = run_bodeflow({"run", "open.yaml", "--dry-run", "--json"}, folder.path());
  const Json device = Json::parse(json.out)[0]["devices"][0];
  CHECK(device["name"] == "drive");
  CHECK(device["gets"][0]["excitation"]["known"] == true);
  CHECK(device["gets"][0]["excitation"]["streams"][0]["channels"][0]["highest"].get<double>() == Approx(1000.0));
  CHECK(device["gets"][0]["limits"] == Json({0}));
  CHECK(device["gives"][0]["limits"] == Json({1}));
}

TEST_CASE("dry run: an excitation that depends on measurements is told to be bounded by its limits alone") {
  const auto ended = run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/drive/modbus_speed_loop.yaml", "--dry-run"});
  INFO(ended.out << ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK_THAT(ended.out,
             Contains("largest excitation: not known before the run, it depends on 'drive'; its limits keep it within"));
  CHECK_THAT(ended.out, Contains("in front of it, reference.out: "));
  CHECK_THAT(ended.out, Contains("trace: drive.modbus_trace"));
}

TEST_CASE("dry run: what goes to the network is shown as what goes to a device") {
  const auto ended = run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/dds/publish.yaml", "--dry-run"});
  INFO(ended.out << ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK_THAT(ended.out, Contains("Devices and network\n") && Contains(": dds.publish\n") && Contains("largest excitation: "));
  CHECK_THAT(ended.out, !Contains("nothing outside"));
}

TEST_CASE("dry run: samples that are no finite numbers are counted") {
  const Folder folder;
  folder.write(
      "graph.yaml",
      "bodeflow: 1\nrun: {duration: 100 ms}\nblocks:\n  ramp: {block: generators.ramp, sample_rate: 100 Hz, slope: 1000}\n"
      "  gain: {block: filters.gain, gain: 1e307}\n"
      "  out: {block: dds.publish, topic: t}\nconnections: [ramp -> gain -> out]\n");
  const auto ended = run_bodeflow({"run", "graph.yaml", "--dry-run"}, folder.path());
  INFO(ended.out << ended.err);
  CHECK_THAT(ended.out, Contains("0 to 1e+308, largest at 10 ms") && Contains("8 samples of it no finite number"));
}
