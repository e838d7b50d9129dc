#include <fstream>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using bodeflow::test::run_program;
using Catch::Matchers::Contains;

namespace {

constexpr const char* kTone =
    "bodeflow: 1\n"
    "run: {duration: 1 ms}\n"
    "blocks:\n"
    "  tone: {block: generators.sine, sample_rate: 10 kHz, frequency: 2500 Hz}\n"
    "  twice: {block: filters.gain, gain: 2}\n"
    "  table: {block: output.csv, file: tone.csv}\n"
    "connections:\n"
    "  - tone -> twice -> table\n"
    "record: [twice]\n";

}  // namespace

TEST_CASE("a run leaves its directory with graph, plan, manifest, events, data and result") {
  const Folder folder;
  folder.write("tone.yaml", kTone);
  const auto ended = run_bodeflow({"run", "tone.yaml", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  for (const char* file : {"graph.yaml", "plan.json", "manifest.json", "events.jsonl", "data.h5", "result.json", "tone.csv"})
    CHECK(std::filesystem::exists(folder.path() / "out" / file));
  const auto manifest = nlohmann::json::parse(folder.read("out/manifest.json"));
  CHECK(manifest["status"] == "complete");
  CHECK(manifest["hashes"].contains("twice.out"));
  CHECK(nlohmann::json::parse(folder.read("out/result.json"))["bodeflow"] == 1);
}

TEST_CASE("a directory that holds a run is not written over") {
  const Folder folder;
  folder.write("tone.yaml", kTone);
  REQUIRE(run_bodeflow({"run", "tone.yaml", "--out", "out"}, folder.path()).exit_code == 0);
  const std::string before = folder.read("out/manifest.json");
  const auto again = run_bodeflow({"run", "tone.yaml", "--out", "out"}, folder.path());
  CHECK(again.exit_code == 1);
  CHECK_THAT(again.err, Contains("out"));
  CHECK(folder.read("out/manifest.json") == before);
}

TEST_CASE("a dry run shows the plan and makes nothing") {
  const Folder folder;
  folder.write("tone.yaml", kTone);
  const auto ended = run_bodeflow({"run", "tone.yaml", "--out", "out", "--dry-run"}, folder.path());
  CHECK(ended.exit_code == 0);
  CHECK_THAT(ended.out, Contains("Nothing was run."));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST_CASE("the duration is set by --for, a parameter by --set, and --json prints the results alone") {
  const Folder folder;
  folder.write("tone.yaml", kTone);
  const auto ended =
      run_bodeflow({"run", "tone.yaml", "--out", "out", "--for", "0.5 ms", "--set", "twice.gain=10", "--json"}, folder.path());
  REQUIRE(ended.exit_code == 0);
  CHECK(nlohmann::json::parse(ended.out)["status"] == "complete");
  const std::string table = folder.read("out/tone.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 6);  // header and 5 samples
  CHECK(std::stod(table.substr(table.find("\n0.0001,") + 8)) == Approx(10.0));
}

TEST_CASE("a wrong --set, --seed or --isa is a usage or graph error") {
  const Folder folder;
  folder.write("tone.yaml", kTone);
  CHECK(run_bodeflow({"run", "tone.yaml", "--set", "twice.gain"}, folder.path()).exit_code == 2);
  CHECK(run_bodeflow({"run", "tone.yaml", "--seed", "-3"}, folder.path()).exit_code == 2);
  CHECK(run_bodeflow({"run", "tone.yaml", "--isa", "z80"}, folder.path()).exit_code == 2);
  const auto unknown = run_bodeflow({"run", "tone.yaml", "--set", "twice.gian=3"}, folder.path());
  CHECK(unknown.exit_code == 3);
  CHECK_THAT(unknown.err, Contains("did you mean"));
}

TEST_CASE("the seed of the command line changes the noise, the same seed repeats it") {
  const Folder folder;
  folder.write("noise.yaml",
               "bodeflow: 1\nrun: {duration: 10 ms}\nblocks:\n  noise: {block: generators.noise, sample_rate: 10 kHz}\n"
               "  table: {block: output.csv, file: noise.csv}\nconnections:\n  - noise -> table\n");
  for (const char* out : {"a", "b"})
    REQUIRE(run_bodeflow({"run", "noise.yaml", "--seed", "7", "--out", out}, folder.path()).exit_code == 0);
  REQUIRE(run_bodeflow({"run", "noise.yaml", "--seed", "8", "--out", "c"}, folder.path()).exit_code == 0);
  CHECK(folder.read("a/noise.csv") == folder.read("b/noise.csv"));
  CHECK(folder.read("a/noise.csv") != folder.read("c/noise.csv"));
}

TEST_CASE("Ctrl-C ends a run as partial, with what was recorded, and exit code 130") {
  const Folder folder;
  folder.write(
      "endless.yaml",
      "bodeflow: 1\nrun: {duration: 1000 s, clock: realtime}\nblocks:\n"
      "  tone: {block: generators.sine, sample_rate: 10 kHz, frequency: 100 Hz}\n  twice: {block: filters.gain, gain: 2}\n"
      "  table: {block: output.csv, file: tone.csv}\n"
      "connections:\n  - tone -> twice -> table\nrecord: [twice]\n");
  const auto ended = run_program({"timeout", "--preserve-status", "-s", "INT", "4", BODEFLOW_BUILD_DIR "/bin/bodeflow", "run",
                                  "endless.yaml", "--out", "out"},
                                 folder.path());
  CHECK(ended.exit_code == 130);
  CHECK_THAT(ended.err, Contains("interrupted"));
  const auto manifest = nlohmann::json::parse(folder.read("out/manifest.json"));
  CHECK(manifest["status"] == "partial");
  CHECK(std::filesystem::file_size(folder.path() / "out" / "tone.csv") > 0);
}

TEST_CASE("rerun repeats a run bit for bit, and tells when it does not") {
  const Folder folder;
  folder.write("noise.yaml",
               "bodeflow: 1\nrun: {duration: 1 s, seed: 3}\nblocks:\n  noise: {block: generators.noise, sample_rate: 10 kHz}\n"
               "  twice: {block: filters.gain, gain: 2}\n  table: {block: output.csv, file: noise.csv}\nconnections:\n  - noise "
               "-> twice -> table\nrecord: all\n");
  REQUIRE(
      run_bodeflow({"run", "noise.yaml", "--out", "first", "--seed", "11", "--set", "twice.gain=3"}, folder.path()).exit_code ==
      0);
  const auto again = run_bodeflow({"rerun", "first", "--out", "second"}, folder.path());
  INFO(again.err);
  CHECK(again.exit_code == 0);
  CHECK_THAT(again.out, Contains("all identical bit for bit"));

  auto manifest = nlohmann::json::parse(folder.read("first/manifest.json"));
  manifest["hashes"]["twice.out"] = std::string(64, '0');
  folder.write("first/manifest.json", manifest.dump());
  const auto differs = run_bodeflow({"rerun", "first", "--out", "third"}, folder.path());
  CHECK(differs.exit_code == 1);
  CHECK_THAT(differs.err, Contains("not identical: twice.out"));
  CHECK(run_bodeflow({"rerun", "nowhere"}, folder.path()).exit_code == 2);
}

TEST_CASE("rerun compares the files that blocks wrote, and refuses a run that did not end well") {
  const Folder folder;
  folder.write("noise.yaml",
               "bodeflow: 1\nrun: {duration: 1 s, seed: 5}\nblocks:\n  noise: {block: generators.noise, sample_rate: 1 kHz}\n"
               "  table: {block: output.csv, file: noise.csv}\nconnections:\n  - noise -> table\n");
  REQUIRE(run_bodeflow({"run", "noise.yaml", "--out", "first"}, folder.path()).exit_code == 0);
  CHECK(run_bodeflow({"rerun", "first", "--out", "same"}, folder.path()).exit_code == 0);
  std::string graph = folder.read("first/graph.yaml");
  graph.replace(graph.find("seed: 5"), 7, "seed: 6");
  folder.write("first/graph.yaml", graph);
  const auto differs = run_bodeflow({"rerun", "first", "--out", "other"}, folder.path());
  CHECK(differs.exit_code == 1);
  CHECK_THAT(differs.err, Contains("not identical: files/noise.csv"));

  auto manifest = nlohmann::json::parse(folder.read("same/manifest.json"));
  manifest["status"] = "partial";
  folder.write("same/manifest.json", manifest.dump());
  CHECK(run_bodeflow({"rerun", "same", "--out", "never"}, folder.path()).exit_code == 2);
}

TEST_CASE("a block that writes outside the run directory, or over the run's own files, is refused with its name") {
  const Folder folder;
  const auto writing = [&](const std::string& file) {
    folder.write("escape.yaml",
                 "bodeflow: 1\nrun: {duration: 1 ms}\nblocks:\n  tone: {block: generators.sine, sample_rate: 10 kHz, frequency: "
                 "100 Hz}\n  table: {block: output.csv, file: " +
                     file + "}\nconnections:\n  - tone -> table\n");
    return run_bodeflow({"run", "escape.yaml", "--out", "out-" + std::filesystem::path(file).stem().string()}, folder.path());
  };
  const auto outside = writing("../tone.csv");
  CHECK(outside.exit_code == 3);
  CHECK_THAT(outside.err, Contains("escape.yaml:5:3: block 'table'"));
  CHECK_FALSE(std::filesystem::exists(folder.path() / "tone.csv"));
  const auto own = writing("data.h5");
  CHECK(own.exit_code == 1);
  CHECK_THAT(own.err, Contains("block 'table'"));
}

TEST_CASE("the graph in the README runs as it stands and measures the plant that it writes down") {
  const Folder folder;
  std::ifstream file(BODEFLOW_SOURCE_DIR "/README.md");
  const std::string readme((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto begin = readme.find("```yaml\n") + 8, end = readme.find("```", begin);
  folder.write("readme.yaml", readme.substr(begin, end - begin));
  const auto ended = run_bodeflow({"run", "readme.yaml", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto result = nlohmann::json::parse(folder.read("out/result.json"));
  const auto& gain = result["results"]["dft"]["arrays"]["response"]["data"][0];
  CHECK(gain[0].get<double>() == Approx(1.0).margin(0.05));  // 1 Hz, far below the resonance at 100 rad/s
}

TEST_CASE("run: a topic without its readers ends with the exit code of devices and network") {
  const Folder folder;
  const auto ended = run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/dds/publish.yaml", "--set", "publish.tolerance=100 ms",
                                   "--set", "topic=nobody_reads_this", "--out", "out"},
                                  folder.path());
  CHECK(ended.exit_code == 5);
  CHECK_THAT(ended.err, Contains("block 'publish': topic 'nobody_reads_this': only 0 of 1 readers came"));
}
