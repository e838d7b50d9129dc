#include "system/command.hpp"

#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "tools/report/run_results.hpp"

using namespace bodeflow::test;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

constexpr const char* kChain =
    "bodeflow: 1\n"
    "title: A chain\n"
    "run: {duration: 3 s, seed: 7}\n"
    "blocks:\n"
    "  tone: {block: generators.sine, sample_rate: 10 kHz, frequency: 100 Hz, unit: V}\n"
    "  twice: {block: filters.gain, gain: 2}\n"
    "  noise: {block: generators.noise, sample_rate: 10 kHz, std: 0.1, unit: V}\n"
    "  both: {block: filters.sum}\n"
    "connections:\n"
    "  - tone -> twice -> both.a\n"
    "  - noise -> both.b\n"
    "record: [both]\n";

/// True where Python's XML reader takes every file.
bool are_xml(const std::vector<std::string>& files) {
  std::vector<std::string> command{"python3", "-c",
                                   "import sys, xml.dom.minidom\nfor f in sys.argv[1:]: xml.dom.minidom.parse(f)"};
  command.insert(command.end(), files.begin(), files.end());
  const Ended ended = run_program(command);
  INFO(ended.err);
  CHECK(ended.err.empty());
  return ended.exit_code == 0;
}

}  // namespace

TEST_CASE("report: run leaves a report with the drawing of the graph, given parameters, streams and provenance") {
  const Folder folder;
  folder.write("chain.yaml", kChain);
  REQUIRE(run_bodeflow({"run", "chain.yaml", "--out", "made"}, folder.path()).exit_code == 0);
  const std::string page = folder.read("made/report.html");
  for (const char* text : {"A chain", "Blocks and connections", "sample_rate: 10 kHz, frequency: 100 Hz, unit: V", "defaults",
                           "both.out", "30,000", "10000", "filters", "/made</pre>", "run begins"}) {
    INFO(text);
    CHECK_THAT(page, Contains(text));
  }
  CHECK(
      are_xml({(folder.path() / "made/plots/graph.svg").string(), (folder.path() / "made/plots/stream_both.out.svg").string()}));
}

TEST_CASE("report: a recorded stream shows its greatest and least value, however short the peak") {
  const Folder folder;
  folder.write("chain.yaml",
               "bodeflow: 1\n"
               "run: {duration: 3 s}\n"
               "blocks:\n"
               "  tone: {block: generators.sine, sample_rate: 10 kHz, frequency: 100 Hz}\n"
               "  gain: {block: filters.gain, gain: 1}\n"
               "connections: [tone -> gain]\n"
               "schedule:\n"
               "  - {at: 1.0024 s, block: gain, set: {gain: 57.5}}\n"
               "  - {at: 1.0026 s, block: gain, set: {gain: 1}}\n"
               "record: [gain]\n");
  const auto ran = run_bodeflow({"run", "chain.yaml", "--out", "made"}, folder.path());
  INFO(ran.err);
  REQUIRE(ran.exit_code == 0);
  CHECK_THAT(folder.read("made/report.html"), Contains("<td class=\"n\">57.5</td>"));
}

TEST_CASE("report: drawings of all record types are well-formed XML, and --json lists them") {
  const Folder folder;
  folder.write("run/result.json", result_with(results_of_all_types()).dump());
  const auto ended = run_bodeflow({"report", "run", "--json"}, folder.path());
  REQUIRE(ended.exit_code == 0);
  const auto json = nlohmann::json::parse(ended.out);
  CHECK(json["report"] == "run/report.html");
  CHECK(json["records"] == 18);
  CHECK(json["warnings"].size() >= 2);
  std::vector<std::string> files;
  for (const auto& plot : json["plots"]) files.push_back((folder.path() / plot.get<std::string>()).string());
  CHECK(files.size() > 20);
  CHECK(are_xml(files));
}

TEST_CASE("report: the same run gives the same bytes") {
  const Folder folder;
  folder.write("chain.yaml", kChain);
  REQUIRE(run_bodeflow({"run", "chain.yaml", "--out", "made"}, folder.path()).exit_code == 0);
  const std::string first = folder.read("made/report.html");
  REQUIRE(run_bodeflow({"report", "made"}, folder.path()).exit_code == 0);
  CHECK(folder.read("made/report.html") == first);
}

TEST_CASE("report: what can't be rendered is said, and a run whose report can't be written is no failure") {
  const Folder folder;
  const auto absent = run_bodeflow({"report", "absent"}, folder.path());
  CHECK(absent.exit_code == 2);
  CHECK_THAT(absent.err, Contains("'absent' is no folder"));
  folder.write("run/result.json", "{\"results\": {\"a\": {\"type\": \"x\", \"attr");
  const auto damaged = run_bodeflow({"report", "run"}, folder.path());
  CHECK(damaged.exit_code == 0);
  CHECK_THAT(damaged.err, Contains("result.json is cut off or damaged"));
  const auto nowhere = run_bodeflow({"report", "run", "--out", "no/such/folder/page.html"}, folder.path());
  CHECK(nowhere.exit_code == 2);
}
