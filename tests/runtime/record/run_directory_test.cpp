#include <unistd.h>

#include <fstream>
#include <regex>
#include <set>

#include "catch.hpp"
#include "record/files.hpp"
#include "record/pacing.hpp"
#include "recording_fixture.hpp"

using namespace bodeflow;
using namespace bodeflow::record_tests;
using nlohmann::ordered_json;

namespace {

std::string refused(record::RunDirectory& run, const std::string& block, const std::string& name) {
  const auto path = run.output_path(block, name);
  return path ? "accepted" : path.error();
}

std::vector<ordered_json> read_events(const fs::path& directory) {
  std::vector<ordered_json> events;
  std::ifstream file(directory / "events.jsonl");
  for (std::string line; std::getline(file, line);) events.push_back(ordered_json::parse(line));
  return events;
}

}  // namespace

TEST_CASE("a run directory holds the graph and a manifest with the status running from the start") {
  const TemporaryFolder folder;
  const auto run = make_run(folder.path(), source_graph({source_phase()}));
  const auto manifest = read_json(run->path() / "manifest.json");
  CHECK(manifest["status"] == "running");
  CHECK(manifest["ended"].is_null());
  CHECK(manifest["graph"] == "source");
  CHECK(manifest["graph_file"] == "source.yaml");
  CHECK(manifest["seed"] == 7);
  CHECK(manifest["isa"] == "avx2");
  CHECK(manifest["host"]["name"].get<std::string>() != "");
  CHECK(std::regex_match(manifest["started"].get<std::string>(), std::regex(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z)")));
  CHECK(record::read_text(run->path() / "graph.yaml").value() == "bodeflow: 1\n");
}

TEST_CASE("a directory that holds a run is refused, one with other files is taken") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "run");
  std::ofstream(folder.path() / "run" / "notes.txt") << "mine";
  const auto graph = source_graph({source_phase()});
  { const auto run = make_run(folder.path(), graph); }
  record::RunDirectory::Options options;
  options.directory = folder.path() / "run";
  options.graph_name = "source";
  const auto again = record::RunDirectory::create(options, graph);
  REQUIRE_FALSE(again);
  CHECK(again.error() == "'" + options.directory.string() + "' holds a run already; choose another directory");
  CHECK(record::read_text(folder.path() / "run" / "notes.txt").value() == "mine");
}

TEST_CASE("a directory that can't be made is named with the reason") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  record::RunDirectory::Options options;
  options.graph_name = "source";
  options.directory = folder.path() / "file" / "run";
  const auto run = record::RunDirectory::create(options, source_graph({}));
  REQUIRE_FALSE(run);
  CHECK(run.error() == "can't create the run directory '" + options.directory.string() + "': Not a directory");
}

TEST_CASE("a directory without the right to write is named with the reason") {
  if (::geteuid() == 0) {
    WARN("skipped: the administrator may write everywhere");
    return;
  }
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  record::RunDirectory::Options options;
  options.directory = folder.path() / "run";
  const auto run = record::RunDirectory::create(options, source_graph({}));
  fs::permissions(folder.path(), fs::perms::owner_all);
  REQUIRE_FALSE(run);
  CHECK(run.error() == "can't create the run directory '" + options.directory.string() + "': Permission denied");
}

TEST_CASE("runs without a given directory get one each below runs, named by time and graph") {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  record::RunDirectory::Options options;
  options.graph_name = "my graph";
  std::set<std::string> names;
  for (int i = 0; i < 3; ++i) {
    const auto run = record::RunDirectory::create(options, source_graph({}));
    REQUIRE(run);
    CHECK((*run)->path().parent_path() == fs::canonical(folder.path()) / "runs");
    names.insert((*run)->path().filename().string());
  }
  fs::current_path(before);
  CHECK(names.size() == 3);
  for (const auto& name : names) CHECK(std::regex_match(name, std::regex(R"(\d{8}-\d{6}-my_graph(-\d)?)")));
}

TEST_CASE("closing a run writes its status, reason and end") {
  const TemporaryFolder folder;
  const auto run = make_run(folder.path(), source_graph({source_phase()}));
  REQUIRE(run->close("failed", "block 'motor': on fire"));
  const auto manifest = read_json(run->path() / "manifest.json");
  CHECK(manifest["status"] == "failed");
  CHECK(manifest["reason"] == "block 'motor': on fire");
  CHECK(manifest["ended"].is_string());
  CHECK(read_json(run->path() / "result.json")["status"] == "failed");
}

TEST_CASE("a run that is dropped without being closed is partial") {
  const TemporaryFolder folder;
  { const auto run = make_run(folder.path(), source_graph({source_phase()})); }
  CHECK(read_json(folder.path() / "run" / "manifest.json")["status"] == "partial");
}

TEST_CASE("input files stand in the manifest once, with size and SHA-256") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "data.csv") << "abc";
  const auto run = make_run(folder.path(), source_graph({source_phase()}));
  const std::string path = (folder.path() / "data.csv").string();
  run->note_input("file", path);
  run->note_input("file", path);
  run->note_input("again", (folder.path() / "." / "data.csv").string());
  run->note_input("file", (folder.path() / "absent.csv").string());
  const auto inputs = read_json(run->path() / "manifest.json")["inputs"];
  REQUIRE(inputs.size() == 2);
  CHECK(inputs[0]["size"] == 3);
  CHECK(inputs[0]["sha256"] == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");  // FIPS 180-4, "abc"
  CHECK(inputs[0]["blocks"] == ordered_json({"file", "again"}));
  CHECK(inputs[1]["error"] ==
        "can't read '" + (fs::canonical(folder.path()) / "absent.csv").string() + "': No such file or directory");
}

TEST_CASE("events are lines of JSON with a time, log lines carry time, level and block") {
  const TemporaryFolder folder;
  const auto run = make_run(folder.path(), source_graph({source_phase()}));
  run->event("phase skipped", {{"phase", "identify"}, {"odd", "\xff"}});
  run->log("motor", BF_LOG_WARNING, "hot\nvery");
  const auto events = read_events(run->path());
  REQUIRE(events.size() == 2);
  CHECK(events[0]["event"] == "run begins");
  CHECK(events[1]["event"] == "phase skipped");
  CHECK(events[1]["phase"] == "identify");
  CHECK(events[1].begin().key() == "time");
  const std::string log = record::read_text(run->path() / "log.txt").value();
  CHECK(std::regex_match(log, std::regex(R"(\S+Z warning motor: hot\n  very\n)")));
}

TEST_CASE("output files: a name inside the run directory is given as an absolute path, its folder made") {
  const TemporaryFolder folder;
  const auto run = make_run(folder.path(), source_graph({source_phase()}));
  const auto path = run->output_path("csv", "tables/./response.csv");
  REQUIRE(path);
  CHECK(*path == (fs::canonical(run->path()) / "tables" / "response.csv").string());
  CHECK(fs::is_directory(run->path() / "tables"));
}

TEST_CASE("output files: names that leave the run directory or are taken are refused with the exact reason") {
  const TemporaryFolder folder;
  const auto run = make_run(folder.path(), source_graph({source_phase()}));
  fs::create_directory_symlink(folder.path(), run->path() / "out");
  fs::create_symlink(folder.path() / "elsewhere.csv", run->path() / "link.csv");
  std::ofstream(run->path() / "old.csv") << "1";
  REQUIRE(run->output_path("csv", "response.csv"));

  CHECK(refused(*run, "csv", "") == "output file '': the name of the file is empty");
  CHECK(refused(*run, "csv", "/etc/x") == "output file '/etc/x': the path must be relative: files go into the run directory");
  CHECK(refused(*run, "csv", "a/../../x") == "output file 'a/../../x': '..' is not allowed: files go into the run directory");
  CHECK(refused(*run, "csv", "tables/") == "output file 'tables/': it names a folder, not a file");
  CHECK(refused(*run, "csv", "./data.h5") == "output file './data.h5': the run itself writes that name");
  CHECK(refused(*run, "csv", "out/x.csv") == "output file 'out/x.csv': a symbolic link leads out of the run directory");
  CHECK(refused(*run, "csv", "link.csv") == "output file 'link.csv': a symbolic link leads out of the run directory");
  CHECK(refused(*run, "csv", "old.csv") == "output file 'old.csv': it exists in the run directory already");
  CHECK(refused(*run, "csv", "response.csv") == "output file 'response.csv': block 'csv' writes it already");
  CHECK(refused(*run, "other", "./response.csv") == "output file './response.csv': block 'csv' writes it already");
  CHECK_FALSE(fs::exists(folder.path() / "x.csv"));
}

TEST_CASE("output files: a block's file in a later repetition has a number, another block's name stays refused") {
  const TemporaryFolder folder;
  const auto phase = source_phase("measure");
  const auto run = make_run(folder.path(), source_graph({phase}));
  const auto repeat = [&](int k) {
    REQUIRE(run->begin_phase(phase, source_facts(), nlohmann::json::object(), k));
    const auto path = run->output_path("csv", "t/response.csv");
    REQUIRE(path);
    REQUIRE(run->end_phase({}));
    return fs::path(*path).lexically_relative(fs::canonical(run->path())).string();
  };
  CHECK(repeat(0) == "t/response.csv");
  CHECK(repeat(1) == "t/response@2.csv");
  CHECK(repeat(2) == "t/response@3.csv");
  CHECK(refused(*run, "other", "t/response.csv") == "output file 't/response.csv': block 'csv' writes it already");
}

TEST_CASE("how a phase kept time stands in the manifest and in the event of its end") {
  const TemporaryFolder folder;
  auto phase = source_phase("hold");
  phase.run.clock = graph::Clock::realtime;
  phase.run.on_overrun = graph::Overrun::skip;
  phase.run.priority = 80;
  const auto simulated = source_phase("then");
  const auto run = make_run(folder.path(), source_graph({phase, simulated}));
  execute::LatenessCounter late;
  for (const std::int64_t ns : {900, 1500, 40'000'000}) late.add(ns);
  execute::Outcome outcome;
  outcome.overruns = 1;
  outcome.skipped = 3;
  outcome.lateness = late.summary();
  outcome.not_permitted = {"priority 80 is not permitted"};
  REQUIRE(run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0));
  REQUIRE(run->end_phase(outcome));
  REQUIRE(run->begin_phase(simulated, source_facts(), nlohmann::json::object(), 0));
  REQUIRE(run->end_phase({}));
  const auto phases = read_json(run->path() / "manifest.json")["phases"];
  const auto& pacing = phases[0]["pacing"];
  CHECK(pacing["clock"] == "realtime");
  CHECK(pacing["on_overrun"] == "skip");
  CHECK(pacing["priority"] == 80);
  CHECK(pacing["not_permitted"] == nlohmann::json{"priority 80 is not permitted"});
  CHECK(pacing["overruns"] == 1);
  CHECK(pacing["skipped"] == 3);
  CHECK(pacing["chunks"] == 3);
  CHECK(pacing["max_s"].get<double>() == Approx(0.04));
  CHECK(pacing["bins"].size() == execute::Lateness::kBins);
  CHECK(pacing["bins"][0] == 1);
  CHECK_FALSE(phases[1].contains("pacing"));
  for (const auto& event : read_events(run->path()))
    if (event["event"] == "phase ends" && event["phase"] == "hold") CHECK(event["pacing"] == pacing);
  CHECK(record::pacing_text(pacing) ==
        "3 chunks began late by 1.53 us in the median, 39.9 ms at 99 %, 40 ms at most; 1 overrun, 3 chunks of time left out");
  CHECK(record::pacing_text(record::pacing_json(phase.run, {})) == "");
  CHECK(record::pacing_text(nullptr) == "");
}

TEST_CASE("changes of live parameters stand in the events with block, parameter, value and position") {
  const TemporaryFolder folder;
  const auto phase = source_phase("tune");
  const auto run = make_run(folder.path(), source_graph({phase}));
  const auto sink = run->begin_phase(phase, source_facts(), nlohmann::json::object(), 0);
  REQUIRE(sink);
  ParameterValue gain;
  gain.type = BF_NUMBER;
  gain.rows = 1;
  gain.numbers = {0.1};
  ParameterValue poles;
  poles.type = BF_COMPLEX_LIST;
  poles.rows = 2;
  poles.numbers = {-1.0, 2.0, -1.0, -2.0};
  (*sink)->changed(0, 0, gain, 1234, execute::Cause::schedule);
  (*sink)->changed(0, 1, poles, 1235, execute::Cause::live);
  REQUIRE(run->end_phase({}));
  std::vector<ordered_json> changes;
  for (const auto& event : read_events(run->path()))
    if (event["event"] == "parameter changed") changes.push_back(event);
  REQUIRE(changes.size() == 2);
  CHECK(changes[0]["phase"] == "tune");
  CHECK(changes[0]["block"] == "source");
  CHECK(changes[0]["parameter"] == "gain");
  CHECK(changes[0]["value"] == 0.1);
  CHECK(changes[0]["position"] == 1234);
  CHECK(changes[0]["by"] == "schedule");
  CHECK(changes[1]["by"] == "live");
  CHECK(changes[1]["parameter"] == "poles");
  CHECK(changes[1]["value"] == ordered_json({{-1.0, 2.0}, {-1.0, -2.0}}));
}
