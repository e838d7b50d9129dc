#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;

namespace {

/// A measurement that a later phase may look at: a noisy gain of 2, averaged over 4 periods.
std::string measurement(const std::string& name, const std::string& more) {
  return "  - name: " + name +
         "\n    run: {duration: 0.08 s}\n"
         "    blocks:\n"
         "      excitation: {block: generators.multisine, sample_rate: 10 kHz, period: 100, lines: {first: 1, last: 9, step: "
         "2}}\n"
         "      twice: {block: filters.gain, gain: 2}\n"
         "      noise: {block: generators.noise, sample_rate: 10 kHz, std: 0.01}\n"
         "      sum: {block: filters.sum}\n"
         "      dft: {block: spectrum.averaging_dft, period: 100}\n"
         "    connections:\n"
         "      - excitation -> twice -> sum.a\n"
         "      - noise -> sum.b\n"
         "      - excitation -> dft.input\n"
         "      - sum -> dft.output\n" +
         more;
}

nlohmann::json results(const Folder& folder, const std::string& text) {
  folder.write("graph.yaml", text);
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return nlohmann::json::parse(folder.read("out/result.json"))["results"];
}

}  // namespace

TEST_CASE("a phase runs only when its condition on an earlier record holds") {
  const Folder folder;
  const auto all = results(folder, "bodeflow: 1\nphases:\n" + measurement("first", "") +
                                       measurement("taken", "    when: $first.dft.periods == 8\n") +
                                       measurement("skipped", "    when: $first.dft.periods < 8\n"));
  CHECK(all.contains("first.dft"));
  CHECK(all.contains("taken.dft"));
  CHECK_FALSE(all.contains("skipped.dft"));
}

TEST_CASE("a sweep over seeds runs in worker processes and merges in index order, repeatably") {
  const Folder folder;
  const std::string graph = "bodeflow: 1\nphases:\n" + measurement("many", "    sweep: {seed: 1..5}\n");
  const auto all = results(folder, graph);
  const auto& merged = all["many.dft"];
  CHECK(merged["type"] == "sweep");
  CHECK(merged["attributes"]["of"] == "frequency_response");
  CHECK(merged["attributes"]["runs"] == 5);
  CHECK(merged["arrays"]["axis.seed"]["data"] == nlohmann::json({1.0, 2.0, 3.0, 4.0, 5.0}));
  CHECK(merged["arrays"]["response"]["shape"] == nlohmann::json({5, 5, 1, 1}));
  const Folder again;
  CHECK(results(again, graph)["many.dft"] == merged);
  const Folder single;
  const auto third = results(single, "bodeflow: 1\nrun: {seed: 3}\nphases:\n" + measurement("many", ""));
  CHECK(third["many.dft"]["arrays"]["response"]["data"][0] == merged["arrays"]["response"]["data"][10]);
}

TEST_CASE("a sweep over a parameter gives each run its value") {
  const Folder folder;
  const auto all = results(folder, "bodeflow: 1\nphases:\n" + measurement("gains", "    sweep: {twice.gain: [1, 10]}\n"));
  const auto& data = all["gains.dft"]["arrays"]["response"]["data"];
  CHECK(data[0][0].get<double>() == Approx(1.0).margin(0.05));
  CHECK(data[5][0].get<double>() == Approx(10.0).margin(0.05));
}

TEST_CASE("a phase repeats until its condition holds, at most as often as it says") {
  const Folder folder;
  const auto all =
      results(folder, "bodeflow: 1\nphases:\n" + measurement("again", "    repeat: {max: 3, until: $again.dft.periods > 100}\n"));
  CHECK(all.contains("again.dft"));
  CHECK_THAT(folder.read("out/events.jsonl"), Contains("again"));
}

TEST_CASE("every repetition of a phase has noise of its own, and an until that is never met is said") {
  const Folder folder;
  folder.write("graph.yaml",
               "bodeflow: 1\nphases:\n" +
                   measurement("again", "    record: [noise]\n    repeat: {max: 2, until: $again.dft.periods > 100}\n"));
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK_THAT(ended.err, Contains("'until' was not met in 2 repetitions"));
  const auto hashes = nlohmann::json::parse(folder.read("out/manifest.json"))["hashes"];
  CHECK(hashes["again.noise.out"] != hashes["again@2.noise.out"]);
}

TEST_CASE("a seed on the command line is said to change nothing in a phase that sweeps the seed") {
  const Folder folder;
  folder.write("graph.yaml",
               "bodeflow: 1\nphases:\n" + measurement("many", "    sweep: {seed: 1..2}\n") + measurement("one", ""));
  const auto ended = run_bodeflow({"check", "graph.yaml", "--seed", "3"}, folder.path());
  INFO(ended.err);
  CHECK(ended.exit_code == 0);
  CHECK(ended.err.find("--seed changes nothing in phase 'many', which sweeps the seed itself") != std::string::npos);
  CHECK(ended.err.find("phase 'one'") == std::string::npos);
}

TEST_CASE("rerun compares every run of a sweep") {
  const Folder folder;
  folder.write("graph.yaml", "bodeflow: 1\nphases:\n" + measurement("many", "    sweep: {seed: 1..2}\n"));
  REQUIRE(run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path()).exit_code == 0);
  const auto hashes = nlohmann::json::parse(folder.read("out/manifest.json"))["hashes"];
  CHECK(hashes.contains("sweep/many/0/many.dft.out"));
  CHECK(hashes["sweep/many/0/many.dft.out"] != hashes["sweep/many/1/many.dft.out"]);
  CHECK(run_bodeflow({"rerun", "out", "--out", "again"}, folder.path()).exit_code == 0);
}

TEST_CASE("a failing run of a sweep is named by its index") {
  const Folder folder;
  folder.write("graph.yaml", "bodeflow: 1\nphases:\n" + measurement("bad", "    sweep: {dft.period: [100, 100000]}\n"));
  const auto ended = run_bodeflow({"run", "graph.yaml", "--out", "out"}, folder.path());
  CHECK(ended.exit_code == 1);
  CHECK_THAT(ended.err, Contains("run 1 of the sweep failed") && Contains("dft"));
}
