#include "lab.hpp"

#include <filesystem>
#include <thread>

#include "catch.hpp"

namespace bodeflow::test {
namespace {

void append(std::vector<std::string>& to, const std::vector<std::string>& words) {
  to.insert(to.end(), words.begin(), words.end());
}

/// The command with its messages on standard output.
std::vector<std::string> merged(const std::vector<std::string>& command) {
  std::string line = "exec";
  for (const std::string& word : command) line += " '" + word + "'";
  return {"sh", "-c", line + " 2>&1"};
}

}  // namespace

std::vector<std::string> TestLab::agent_command(const std::string& name, const std::vector<std::string>& more) const {
  std::vector<std::string> command = {BODEFLOW_COMMAND, "agent", "--name", name, "--runs", path("agent_" + name)};
  append(command, options_);
  append(command, more);
  return merged(command);
}

Process& TestLab::agent(const std::string& name, const std::vector<std::string>& more, const std::vector<std::string>& before) {
  std::vector<std::string> all = before;
  append(all, agent_command(name, more));
  agents_.push_back(std::make_unique<Process>(all));
  INFO(agents_.back()->output());
  REQUIRE(agents_.back()->prints("is there"));
  return *agents_.back();
}

std::vector<std::string> TestLab::run(const std::string& graph, const std::string& out,
                                      const std::vector<std::string>& more) const {
  std::vector<std::string> command = {BODEFLOW_COMMAND, "run", graph, "--out", path(out)};
  append(command, options_);
  append(command, more);
  return merged(command);
}

std::vector<std::string> TestLab::run_here(const std::string& graph, const std::string& out) const {
  return merged({BODEFLOW_COMMAND, "run", graph, "--here", "--out", path(out)});
}

nlohmann::json TestLab::hashes(const std::string& out) const {
  return nlohmann::json::parse(folder_.read(out + "/manifest.json"))["hashes"];
}

std::vector<std::string> TestLab::runs_of(const std::string& agent) const {
  std::vector<std::string> runs;
  std::error_code error;
  for (const auto& run : std::filesystem::directory_iterator(path("agent_" + agent), error)) runs.push_back(run.path().string());
  return runs;
}

bool TestLab::has_graph(const std::string& agent) const {
  for (int i = 0; i < 200; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(50)))
    for (const std::string& run : runs_of(agent))
      if (std::filesystem::exists(run + "/graph.yaml")) return true;
  return false;
}

void TestLab::crash(const std::string& agent) const { (void)shell("pkill -9 -f -- '--runs " + path("agent_" + agent) + " '"); }

}  // namespace bodeflow::test
