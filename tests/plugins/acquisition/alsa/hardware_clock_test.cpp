// Whole runs that a sound card paces, in place of the clock of the system.
#include "catch.hpp"
#include "sound_card_bench.hpp"

using bodeflow::test::column;
using bodeflow::test::SoundCardBench;
using nlohmann::json;

namespace {

constexpr std::size_t kDelay = 37;

struct Paced {
  double wall_s = 0.0;
  json device, pacing;
  std::string captured;
};

/// Plays and captures for `duration` nominal seconds on a card whose clock runs wrong by `ppm`. What is captured is what was
/// played kDelay samples before, to the last bit.
Paced run_on_card(int ppm, const std::string& duration) {
  const SoundCardBench bench("delay " + std::to_string(kDelay) + " ppm " + std::to_string(ppm));
  const auto graph = bench.folder.write(
      "loop.yaml",
      "bodeflow: 1\nrun: {clock: hardware, chunk: 480, duration: " + duration +
          ", seed: 1}\nblocks:\n"
          "  u: {block: generators.multisine, sample_rate: 48 kHz, period: 4800, lines: {first: 1, last: 2000}, rms: "
          "0.1}\n"
          "  card: {block: acquisition.alsa_duplex, device: loop, buffer: 65536, lead: 24000, on_gap: end}\n"
          "  played: {block: output.csv, file: played.csv}\n"
          "  captured: {block: output.csv, file: captured.csv}\n"
          "connections:\n  - u -> card\n  - card.played -> played\n  - card.captured -> captured\n");
  const json results = bench.results({graph.string()});
  const json phase = json::parse(bench.folder.read("out/manifest.json"))["phases"][0];
  Paced paced{phase["wall_s"].get<double>(), results["card"]["attributes"], phase["pacing"],
              bench.folder.read("out/captured.csv")};
  const auto played = column(bench.folder.read("out/played.csv"), 1), captured = column(paced.captured, 1);
  REQUIRE(captured.size() == played.size());
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < captured.size(); ++n) wrong += captured[n] != (n < kDelay ? 0.0 : played[n - kDelay]);
  CHECK(wrong == 0);
  CHECK(paced.device["overruns"] == 0);
  CHECK(paced.device["underruns"] == 0);
  CHECK(paced.pacing["clock"] == "hardware");
  CHECK(paced.pacing["chunks"] == 0);  // nothing to be late against
  return paced;
}

}  // namespace

TEST_CASE("hardware clock: a run takes the time of a card at half its speed and gives the same bits") {
  const Paced slow = run_on_card(-500'000, "1 s");
  CHECK(slow.wall_s > 1.9);
  CHECK(slow.device["measured_rate"].get<double>() == Approx(24e3).epsilon(2e-3));
  CHECK(slow.captured == run_on_card(0, "1 s").captured);
}

TEST_CASE("hardware clock: a run follows a card that is 2 % fast") {
  CHECK(run_on_card(20'000, "1 s").device["measured_rate"].get<double>() == Approx(48960).epsilon(2e-3));
}

TEST_CASE("hardware clock: a run loses nothing of a card that would overflow its buffer at the system's pace") {
  run_on_card(500'000, "4 s");  // 96,000 samples too many in 4 s, for a buffer of 65,536
}
