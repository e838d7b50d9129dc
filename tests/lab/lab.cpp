#include "lab.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "catch.hpp"
#include "processes_of.hpp"
#include "record/data_file.hpp"

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

void sleep_s(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

double since_s(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

std::string closed_loop(const std::string& run) {
  return "bodeflow: 1\nrun: {" + run + R"(}
blocks:
  reference: {block: generators.square, sample_rate: 100 Hz, frequency: 1 Hz}
  error: {block: filters.sum, weights: [1, -1]}
  pi: {block: plants.linear, domain: discrete, numerator: [0.1, -0.09], denominator: [1, -1]}
  way: {block: filters.delay, samples: 2}
  motor: {block: plants.linear, numerator: [1], denominator: [0.1, 1]}
  speed: {block: filters.gain, gain: 1}
connections: [reference -> error.a, error -> pi -> way -> motor -> error.b, motor -> speed]
record: [speed.out, pi.out]
hosts: {bench: [way, motor], controller: [error, pi]}
)";
}

int loop_samples(const nlohmann::json& link, int samples) {
  return link["sends"] == false && link["connection"] == "pi.out -> way.in" ? samples - 2 : samples;
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::vector<std::string> network_options(const std::vector<std::string>& trust) {
  std::vector<std::string> options = {"--domain", std::to_string(test_domain())};
  append(options, trust);
  return options;
}

bool skipped(const Hosts& hosts) {
  if (!hosts.missing().empty()) WARN("skipped: " << hosts.missing());
  return !hosts.missing().empty();
}

std::vector<std::string> TestLab::agent_command(const std::string& name, const std::vector<std::string>& more) const {
  std::vector<std::string> command = {BODEFLOW_COMMAND, "agent", "--name", name, "--runs", path("agent_" + name)};
  append(command, options_);
  append(command, more);
  return merged(command);
}

Process& TestLab::agent(const std::string& name, const std::vector<std::string>& more, const std::vector<std::string>& before,
                        int most_s) {
  std::vector<std::string> all = before;
  append(all, agent_command(name, more));
  agents_.push_back(std::make_unique<Process>(all, most_s));
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

void TestLab::agents_on(const Hosts& hosts) {
  agent("bench", {"--interface", Hosts::address(1)}, hosts.on(1, {}));
  agent("controller", {"--interface", Hosts::address(2)}, hosts.on(2, {}));
}

std::vector<std::string> TestLab::run_on(const Hosts& hosts, const std::string& graph, const std::string& out) const {
  return hosts.on(0, run(graph, out, {"--interface", Hosts::address(0)}));
}

nlohmann::json TestLab::manifest(const std::string& out) const {
  return nlohmann::json::parse(folder_.read(out + "/manifest.json"));
}

nlohmann::json TestLab::hashes(const std::string& out) const { return manifest(out)["hashes"]; }

std::vector<double> TestLab::stream(const std::string& file, const std::string& key) const {
  const auto data = record::DataFile::open(path(file));
  if (!data) FAIL(data.error());
  const auto* stream = (*data)->stream(key);
  REQUIRE(stream != nullptr);
  return (*data)->read(*stream, 0, stream->length).value();
}

std::vector<nlohmann::json> TestLab::links(const std::string& out) const {
  std::vector<nlohmann::json> all;
  std::ifstream events(path(out + "/events.jsonl"));
  for (std::string line; std::getline(events, line);) {
    const auto event = nlohmann::json::parse(line);
    if (event["event"] != "host ends") continue;
    for (nlohmann::json link : event["end"]["links"]) {
      link["host"] = event["host"];
      all.push_back(link);
    }
  }
  return all;
}

nlohmann::json TestLab::hashes_here(std::string text) const {
  if (const auto at = text.find("realtime"); at != std::string::npos) text.replace(at, 8, "simulated");
  Process here(run_here(folder_.write("here.yaml", text).string(), "here"));
  const int code = here.wait();
  INFO(here.output());
  REQUIRE(code == 0);
  const nlohmann::json kept = hashes("here");
  REQUIRE_FALSE(kept.empty());
  return kept;
}

void TestLab::require_complete(Process& run, const std::string& out, const nlohmann::json& hashes) const {
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  CHECK(this->hashes(out) == hashes);
}

nlohmann::json TestLab::top() const {
  std::vector<std::string> command = {BODEFLOW_COMMAND, "top", "--json", "--once"};
  append(command, options_);
  Process top(command);
  REQUIRE(top.wait() == 0);
  return nlohmann::json::parse(top.output());
}

std::vector<std::string> TestLab::runs_of(const std::string& agent) const {
  std::vector<std::string> runs;
  std::error_code error;
  for (const auto& run : std::filesystem::directory_iterator(path("agent_" + agent), error)) runs.push_back(run.path().string());
  return runs;
}

bool TestLab::has_graph(const std::string& agent) const {
  for (const auto begin = Clock::now(); since_s(begin) < 10.0; sleep_s(0.05))
    for (const std::string& run : runs_of(agent))
      if (std::filesystem::exists(run + "/graph.yaml")) return true;
  return false;
}

std::string TestLab::begun(const std::string& host, int epoch) const {
  const auto begins = [&](const std::string& run) {
    const std::string name = std::filesystem::path(run).filename().string();
    if (epoch == 0 ? name.find('-') != std::string::npos : !name.ends_with("-" + std::to_string(epoch))) return false;
    return text_of(run + "/events.jsonl").find("phase begins") != std::string::npos;
  };
  for (const auto begin = Clock::now(); since_s(begin) < 20.0; sleep_s(0.02))
    for (const std::string& run : runs_of(host))
      if (begins(run)) return run;
  FAIL("no part of " << host << " began within 20 s");
  return "";
}

int TestLab::part_of(const std::string& host) const {
  for (const auto begin = Clock::now(); since_s(begin) < 10.0; sleep_s(0.02))
    if (const auto found = processes_with({"part-worker", path("agent_" + host)}); !found.empty()) return found.front();
  return 0;
}

void TestLab::crash(const std::string& agent) const { (void)shell("pkill -9 -f -- '--runs " + path("agent_" + agent) + " '"); }

}  // namespace bodeflow::test
