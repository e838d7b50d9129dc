// The graphs of graphs/kallen_1992 beside the reference runs, and what the engine refuses of such loops.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Json = nlohmann::json;

namespace {

Json result(const std::string& graph, const std::vector<std::string>& settings = {}) {
  const Folder folder;
  std::vector<std::string> words{"run", BODEFLOW_SOURCE_DIR "/graphs/" + graph, "--out", "out"};
  words.insert(words.end(), settings.begin(), settings.end());
  const auto ended = run_bodeflow(words, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return Json::parse(folder.read("out/result.json"))["results"];
}

std::map<std::string, std::vector<double>> reference(const std::string& name) {
  std::ifstream file(BODEFLOW_TEST_DATA "/adaptive_control/" + name);
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::string> names;
  for (std::stringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
  std::map<std::string, std::vector<double>> columns;
  while (std::getline(file, line)) {
    std::size_t i = 0;
    for (std::stringstream cells(line); std::getline(cells, cell, ',');) columns[names[i++]].push_back(std::stod(cell));
  }
  return columns;
}

double difference(const Json& record, const char* array, const std::vector<double>& expected) {
  const auto found = record["arrays"][array]["data"].get<std::vector<double>>();
  REQUIRE(found.size() == expected.size());
  double largest = 0.0;
  for (std::size_t n = 0; n < found.size(); ++n) largest = std::max(largest, std::abs(found[n] - expected[n]));
  return largest;
}

double attribute(const Json& record, const char* name, std::size_t at) { return record["attributes"][name].at(at).get<double>(); }

}  // namespace

TEST_CASE("the base line of example 1 as a graph follows the reference run to 1e-8 in every sample") {
  const Json run = result("kallen_1992/example_1_base_line.yaml")["run"];
  auto expected = reference("ex1_base_closed_loop.csv");
  CHECK(difference(run, "command", expected["uc"]) == 0.0);
  CHECK(difference(run, "output", expected["y"]) < 1e-8);
  CHECK(difference(run, "control", expected["u"]) < 1e-8);
  CHECK(difference(run, "desired", expected["ym"]) < 1e-8);
}

TEST_CASE("examples 2 and 3 with all nets keep a unit load as the known plant's controller does") {
  for (const char* graph : {"kallen_1992/example_2.yaml", "kallen_1992/example_3.yaml"}) {
    INFO(graph);
    const Json all = result(graph);
    CHECK(attribute(all["adaptive_run"], "rms_in_windows", 1) < 1.1 * attribute(all["known_run"], "rms_in_windows", 1));
  }
}

TEST_CASE("the report of an adaptive run lists what the safety nets did in order of time, with the cause") {
  const Folder folder;
  const auto ended =
      run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/kallen_1992/example_1_noise.yaml", "--out", "out"}, folder.path());
  REQUIRE(ended.exit_code == 0);
  const Json run = Json::parse(folder.read("out/result.json"))["results"]["adaptive_run"];
  const auto actions = run["attributes"]["net_actions"].get<std::vector<std::string>>();
  const auto times = run["arrays"]["net_action_time"]["data"].get<std::vector<double>>();
  REQUIRE(actions.size() == times.size());
  CHECK(std::is_sorted(times.begin(), times.end()));
  const auto lists = [&](const char* text) {
    return std::any_of(actions.begin(), actions.end(), [&](const auto& a) { return a.find(text) != std::string::npos; });
  };
  CHECK(lists("residual clipping begins at "));
  CHECK(lists("rate limit begins: the new controller is far from the one in use"));
  const std::string page = folder.read("out/report.html");
  CHECK(page.find("Safety nets") != std::string::npos);
  CHECK(page.find("Tracking error") != std::string::npos);
}

TEST_CASE("section 3.4 as a graph: the largest stable bandwidth lies between 0.85 and 0.86, and ringing is named") {
  const Json all = result("kallen_1992/section_3_4.yaml");
  const double limit = all["nominal_05"]["attributes"]["largest_stable_bandwidth"];
  CHECK(limit > 0.85);
  CHECK(limit < 0.86);
  CHECK(all["nominal_086"]["attributes"]["accepted"] == false);
  CHECK(all["nominal_08.advice"]["attributes"]["warnings"].dump().find("leftmost controller pole at -0.49") != std::string::npos);
}

TEST_CASE("an unknown plant comes to a running controller by a relay experiment and a plan") {
  const Json all = result("kallen_1992/start_up.yaml");
  CHECK(all["experiment.relay"]["attributes"]["omega_180"].get<double>() == Approx(0.634).epsilon(0.06));
  CHECK(all["control.design"]["attributes"]["adapted"] == true);
  CHECK(all["control.run"]["attributes"]["largest_control"].get<double>() < 5.0);
}

TEST_CASE("a loop of controller and plant without any delay is refused by name") {
  const Folder folder;
  folder.write("loop.yaml",
               "bodeflow: 1\nrun: {duration: 10 s}\nblocks:\n"
               "  command: {block: generators.step, sample_rate: 1 Hz}\n"
               "  controller: {block: adaptive_control.rst, r: [1, -1], s: [1, -0.5], t: [1, -0.5]}\n"
               "  plant: {block: filters.gain, gain: 2}\n"
               "connections:\n  - command -> controller.setpoint\n  - controller.u -> plant -> controller.y\n");
  const auto ended = run_bodeflow({"check", "loop.yaml"}, folder.path());
  CHECK(ended.exit_code == 3);
  INFO(ended.err);
  CHECK(ended.err.find("controller") != std::string::npos);
  CHECK(ended.err.find("delay") != std::string::npos);
}
