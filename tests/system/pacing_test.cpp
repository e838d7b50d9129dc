// Runs that are held to outside time, as whole commands. What is asserted holds on any machine, however busy.
#include <nlohmann/json.hpp>
#include <numeric>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using nlohmann::json;

namespace {

json manifest_of(const Folder& folder, const std::string& graph, const std::string& out, std::vector<std::string> settings) {
  std::vector<std::string> words{"run", graph, "--out", out};
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  const auto ended = run_bodeflow(words, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return json::parse(folder.read(out + "/manifest.json"));
}

/// A measurement of a noisy plant in chunks of one sample at 1 kHz.
void run_at_1_khz(int seconds) {
  const Folder folder;
  const auto graph = folder.write(
      "graph.yaml", "bodeflow: 1\nrun: {clock: realtime, chunk: 1, duration: " + std::to_string(seconds) +
                        " s, seed: 1}\nblocks:\n"
                        "  u: {block: generators.multisine, sample_rate: 1 kHz, period: 1000, lines: {first: 1, last: 99}}\n"
                        "  plant: {block: plants.linear, numerator: [1e4], denominator: [1, 20, 1e4]}\n"
                        "  noise: {block: generators.noise, sample_rate: 1 kHz, std: 0.01}\n"
                        "  sum: {block: filters.sum}\n"
                        "  dft: {block: spectrum.averaging_dft, period: 1000, skip: 1}\n"
                        "connections:\n  - u -> plant -> sum.a\n  - noise -> sum.b\n  - u -> dft.input\n  - sum -> dft.output\n"
                        "record: [sum]\n");
  const json paced = manifest_of(folder, graph.string(), "paced", {"run.priority=50"});
  const json& phase = paced["phases"][0];
  const json& pacing = phase["pacing"];
  const std::uint64_t samples = 1000 * static_cast<std::uint64_t>(seconds);
  for (const auto& block : phase["blocks"]) {
    CHECK(block["firings"] == samples);
    CHECK(block["dropped"] == 0);
  }
  CHECK(pacing["chunks"] == samples - 1);  // the first one begins the clock
  const auto bins = pacing["bins"].get<std::vector<std::uint64_t>>();
  CHECK(std::accumulate(bins.begin(), bins.end(), std::uint64_t{0}) == samples - 1);
  CHECK(pacing["skipped"] == 0);
  CHECK(pacing["min_s"] <= pacing["median_s"]);
  CHECK(pacing["median_s"] <= pacing["p99_s"]);
  CHECK(pacing["p99_s"] <= pacing["max_s"]);
  CHECK(phase["wall_s"].get<double>() >= seconds - 0.001);

  const json simulated = manifest_of(folder, graph.string(), "simulated", {"run.clock=simulated"});
  CHECK(simulated["hashes"] == paced["hashes"]);
  CHECK_FALSE(simulated["phases"][0].contains("pacing"));
}

}  // namespace

TEST_CASE("pacing: every chunk at 1 kHz begins at its time or later, is counted once, and gives the bits of simulated time") {
  run_at_1_khz(3);
}

TEST_CASE("pacing: the same for a minute", "[.minutes]") { run_at_1_khz(60); }

TEST_CASE("pacing: the same for ten minutes", "[long]") { run_at_1_khz(600); }

TEST_CASE("pacing: the adaptive current loop at 1, 5 and 10 kHz gives the bits of simulated time") {
  const std::pair<const char*, int> kRates[] = {{"1khz", 500}, {"5khz", 2500}, {"10khz", 5000}};
  for (const auto& [name, samples] : kRates) {
    INFO(name);
    const Folder folder;
    const std::string graph = BODEFLOW_SOURCE_DIR "/graphs/drive/current_loop_" + std::string(name) + ".yaml";
    const json paced = manifest_of(folder, graph, "paced", {"run.duration=0.5 s"});
    const json& phase = paced["phases"][0];
    CHECK(phase["blocks"]["controller"]["firings"] == samples);
    CHECK(phase["pacing"]["chunks"] == samples - 1);
    CHECK(paced["hashes"] == manifest_of(folder, graph, "simulated", {"run.duration=0.5 s", "run.clock=simulated"})["hashes"]);
  }
}
