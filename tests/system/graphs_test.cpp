#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
namespace fs = std::filesystem;

namespace {

/// The measurement that a graph needs, as a path below the shared data; "" for a graph that stands alone.
std::string data_of(const std::string& graph) {
  static const std::map<std::string, std::string> files{
      {"measuring/bench_distortion.yaml", "motorbench_two_mass/multisine_B.csv"},
      {"first_steps/measured_frequency_response.yaml", "motorbench_two_mass/multisine_A.csv"},
      {"measuring/fine_steering_mirror.yaml", "fine_steering_mirror/fsm_300mV_train.csv"},
      {"measuring/silverbox.yaml", "silverbox/SNLS80mV.csv"},
      {"jue_1998/example_4.yaml", "loudspeaker_impedance/L16RNX_0g.csv"}};
  const auto found = files.find(graph);
  return found == files.end() ? "" : found->second;
}

fs::path shared_data() {
  const char* given = std::getenv("BODEFLOW_DATA");
  return given != nullptr ? fs::path(given) : fs::path(BODEFLOW_SOURCE_DIR) / ".." / "shared" / "data";
}

/// A drive stands behind these; they are run with the simulated one beside it.
bool needs_device(const fs::path& graph) { return graph.filename().string().rfind("modbus_", 0) == 0; }

std::vector<fs::path> graphs(std::initializer_list<const char*> folders) {
  std::vector<fs::path> found;
  for (const char* folder : folders)
    for (const auto& entry : fs::directory_iterator(fs::path(BODEFLOW_SOURCE_DIR) / "graphs" / folder))
      if (entry.path().extension() == ".yaml" && !needs_device(entry.path())) found.push_back(entry.path());
  std::sort(found.begin(), found.end());
  return found;
}

/// Runs each as it stands, twice, with other chunks and threads.
void check_graphs(std::initializer_list<const char*> folders) {
  for (const fs::path& graph : graphs(folders)) {
    std::vector<std::string> command{"run", graph.string()};
    if (const std::string data = data_of((graph.parent_path().filename() / graph.filename()).string()); !data.empty()) {
      const fs::path file = shared_data() / data;
      if (!fs::exists(file)) {
        std::cout << "skipped: " << graph.filename().string() << " needs " << file.string() << " (set BODEFLOW_DATA)\n";
        continue;
      }
      command.insert(command.end(), {"--set", "data=" + fs::absolute(file).string()});
    }
    INFO(graph.string());
    const Folder folder;
    const auto run = [&](const std::string& out, const std::string& chunk, const std::string& threads) {
      auto words = command;
      words.insert(words.end(), {"--out", out, "--set", "run.chunk=" + chunk, "--threads", threads});
      const auto ended = run_bodeflow(words, folder.path());
      INFO(ended.err);
      REQUIRE(ended.exit_code == 0);
      CHECK(fs::exists(folder.path() / out / "report.html"));
      return nlohmann::json::parse(folder.read(out + "/manifest.json"))["hashes"];
    };
    const auto hashes = run("a", "1024", "1");
    CHECK_FALSE(hashes.empty());
    CHECK(run("b", "61", "2") == hashes);
  }
}

}  // namespace

TEST_CASE(
    "every graph of first_steps, measuring, drive, akcay_1999 and kallen_1992 runs as it stands, to the same bits for any chunk "
    "and thread count, with a report") {
  check_graphs({"first_steps", "measuring", "drive", "akcay_1999", "kallen_1992"});
}

TEST_CASE("every graph of jue_1998 runs as it stands, to the same bits for any chunk and thread count, with a report", "[long]") {
  check_graphs({"jue_1998"});
}
