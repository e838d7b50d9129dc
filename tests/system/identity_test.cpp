#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;

namespace {

/// The hashes of every output and record of a run.
nlohmann::json hashes(const Folder& folder, const std::string& graph, const std::string& chunk, const std::string& threads) {
  const std::string out = "out-" + chunk + "-" + threads;
  const auto ended =
      run_bodeflow({"run", graph, "--set", "run.chunk=" + chunk, "--threads", threads, "--out", out}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return nlohmann::json::parse(folder.read(out + "/manifest.json"))["hashes"];
}

void require_identity(const std::string& graph) {
  const Folder folder;
  const std::string file = std::string(BODEFLOW_SOURCE_DIR "/graphs/first_steps/") + graph;
  const auto first = hashes(folder, file, "1", "1");
  REQUIRE_FALSE(first.empty());
  for (const char* chunk : {"7", "64", "256", "1000", "1024"}) {
    INFO("chunk " << chunk);
    CHECK(hashes(folder, file, chunk, "1") == first);
  }
  for (const char* threads : {"2", "4"}) {
    INFO("threads " << threads);
    CHECK(hashes(folder, file, "1024", threads) == first);
    CHECK(hashes(folder, file, "64", threads) == first);
  }
}

}  // namespace

TEST_CASE("every output of a loop-free graph is the same for any chunk and thread count") {
  require_identity("frequency_response.yaml");
}
TEST_CASE("every output of a feedback loop is the same for any chunk and thread count") {
  require_identity("feedback_loop.yaml");
}
TEST_CASE("every output of a cascaded loop is the same for any chunk and thread count") {
  require_identity("cascaded_loop.yaml");
}
TEST_CASE("every output of a graph with live changes is the same for any chunk and thread count") {
  require_identity("live_change.yaml");
}
