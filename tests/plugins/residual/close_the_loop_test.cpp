#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using nlohmann::json;

namespace {

const std::string kGraph = BODEFLOW_SOURCE_DIR "/graphs/close_the_loop/first.yaml";

struct Outcome {
  std::string verdict, named;
  bool right = false;
  bool at_floor = false;
};

/// The graph as a user runs it, on a bench that may hide these effects.
json results_of(const std::string& effects, int seed) {
  const Folder folder;
  const auto ended = run_bodeflow(
      {"run", kGraph, "--seed", std::to_string(seed), "--set", "effects=[" + effects + "]", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return json::parse(folder.read("out/result.json"))["results"];
}

Outcome outcome_of(const std::string& effect, int seed) {
  const json results = results_of(effect, seed);
  const json &trace = results["trace.trace"]["attributes"], &reveal = results["open.reveal"]["attributes"];
  Outcome o;
  o.verdict = trace["verdict"];
  o.named = trace["effects"].empty() ? "" : trace["effects"][0];
  o.right = reveal["right"];
  o.at_floor = trace["at_floor"];
  return o;
}

std::vector<Outcome> outcomes(const std::string& effect, int runs) {
  std::vector<Outcome> all;
  for (int seed = 1; seed <= runs; ++seed) all.push_back(outcome_of(effect, seed));
  return all;
}

/// "dead_time: named dead_time 40": a row of the confusion matrix.
std::string row(const std::string& effect, const std::vector<Outcome>& all) {
  std::map<std::string, int> counts;
  for (const Outcome& o : all) ++counts[o.verdict + (o.named.empty() ? "" : " " + o.named)];
  std::ostringstream text;
  text << effect << ":";
  for (const auto& [name, count] : counts) text << "  " << name << " " << count;
  return text.str();
}

int count_if(const std::vector<Outcome>& all, bool Outcome::*member) {
  return static_cast<int>(std::count_if(all.begin(), all.end(), [member](const Outcome& o) { return o.*member; }));
}

void require_right(const std::string& effect) {
  const Outcome o = outcome_of(effect, 11);
  CHECK(o.right);
  CHECK(o.at_floor);
}

}  // namespace

TEST_CASE("first closed loop: a bench that hides nothing is left alone") { require_right("none"); }
TEST_CASE("first closed loop: a delay is found on the drive bench") { require_right("delay"); }
TEST_CASE("first closed loop: a dead time is found on the drive bench") { require_right("dead_time"); }
TEST_CASE("first closed loop: saturation is found on the drive bench") { require_right("saturation"); }

TEST_CASE("first closed loop: the graph as it stands names the effect, shows it on one screen and opens the truth last") {
  const Folder folder;
  const auto ended = run_bodeflow({"run", kGraph, "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto finding = ended.out.find("Missing effect: "), truth = ended.out.find("Right: the bench hid ");
  REQUIRE(finding != std::string::npos);
  REQUIRE(truth != std::string::npos);
  CHECK(finding < truth);
  CHECK(std::count(ended.out.begin(), ended.out.end(), '\n') <= 45);
  const json results = json::parse(folder.read("out/result.json"))["results"];
  CHECK(results["trace.trace"]["attributes"]["verdict"] == "named");
  CHECK(results["trace.trace"]["attributes"]["error_remedied"].is_null());
  CHECK(results["trace.trace.extended_model"]["type"] == "model");
  CHECK(json::parse(folder.read("out/truth.jsonl"))["attributes"]["effect"] ==
        results["trace.trace"]["attributes"]["effects"][0]);
}

TEST_CASE("first closed loop: the same bits for any chunk and thread count") {
  const Folder folder;
  const auto hashes = [&](const std::string& chunk, const std::string& threads) {
    const std::string out = "out-" + chunk + "-" + threads;
    const auto ended =
        run_bodeflow({"run", kGraph, "--set", "run.chunk=" + chunk, "--threads", threads, "--out", out}, folder.path());
    INFO(ended.err);
    REQUIRE(ended.exit_code == 0);
    return json::parse(folder.read(out + "/manifest.json"))["hashes"];
  };
  const json first = hashes("1024", "1");
  REQUIRE_FALSE(first.empty());
  CHECK(hashes("333", "2") == first);
}

TEST_CASE("first closed loop: 40 benches of each effect are told right, and 100 clean ones left alone", "[long]") {
  for (const char* effect : {"delay", "dead_time", "saturation"}) {
    const auto all = outcomes(effect, 40);
    std::cout << row(effect, all) << "\n";
    INFO(row(effect, all));
    CHECK(count_if(all, &Outcome::right) >= 38);
    CHECK(count_if(all, &Outcome::at_floor) >= 38);
  }
  const auto clean = outcomes("none", 100);
  std::cout << row("none", clean) << "\n";
  INFO(row("none", clean));
  CHECK(std::count_if(clean.begin(), clean.end(), [](const Outcome& o) { return !o.named.empty(); }) <= 1);
}
