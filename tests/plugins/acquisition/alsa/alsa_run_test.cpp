// The ALSA blocks in whole runs, on the sound card of loop_pcm.cpp.
#include <complex>
#include <functional>
#include <map>
#include <numbers>

#include "acquisition/alsa/pcm.hpp"
#include "catch.hpp"
#include "sound_card_bench.hpp"

using bodeflow::acquisition::Direction;
using bodeflow::acquisition::Pcm;
using bodeflow::acquisition::PcmSpec;
using bodeflow::acquisition::SampleFormat;
using bodeflow::test::column;
using bodeflow::test::Ended;
using bodeflow::test::kSoundCardGraphs;
using bodeflow::test::run_bodeflow;
using bodeflow::test::SoundCardBench;
using Catch::Matchers::Contains;
using nlohmann::json;
using Complex = std::complex<double>;
namespace fs = std::filesystem;

namespace {

/// A variable of this process's own environment.
class Variable {
 public:
  Variable(const char* name, const fs::path& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

/// b0 .. a2 of the section below, at z.
constexpr double kB[] = {0.02, 0.04, 0.02}, kA[] = {-1.56, 0.64};
const std::string kSection = "b [ 0.02 0.04 0.02 ] a [ -1.56 0.64 ]";

Complex section(double frequency_hz, double delay) {
  const Complex w = std::polar(1.0, -2 * std::numbers::pi * frequency_hz / 48e3);
  return (kB[0] + w * (kB[1] + w * kB[2])) / (1.0 + w * (kA[0] + w * kA[1])) * std::pow(w, delay);
}

/// How many lines of a response have the truth in their confidence circle.
int inside(const json& response, double delay) {
  const auto& arrays = response["arrays"];
  const auto frequency = arrays["frequency"]["data"].get<std::vector<double>>();
  int count = 0;
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    const auto& g = arrays["response"]["data"][k];
    count += std::abs(Complex(g[0], g[1]) - section(frequency[k], delay)) <= arrays["confidence_radius"]["data"][k].get<double>();
  }
  return count;
}

}  // namespace

TEST_CASE("a multisine played and captured identifies the filter and the delay of the loop within the confidence circles") {
  const SoundCardBench bench("delay 37 noise 1e-4 " + kSection);
  const auto results = bench.measure("sound_card.yaml", {});
  REQUIRE(results["response"]["arrays"]["frequency"]["data"].size() == 180);
  CHECK(inside(results["response"], 37) >= 162);  // 95 % of 180, less 3.1 standard deviations
  CHECK(inside(results["response"], 36) == 0);
  const auto& device = results["card"]["attributes"];
  CHECK(device["overruns"] == 0);
  CHECK(device["underruns"] == 0);
  CHECK(device["clipped"] == 0);
  CHECK(device["clock"] == "alsa:loop");
  CHECK(device["measured_rate"].get<double>() == Approx(48e3).epsilon(1e-3));
}

TEST_CASE("the round trip is measured by its graph") {
  const SoundCardBench bench("delay 123 noise 1e-4");
  const auto delay = bench.measure("sound_card_round_trip.yaml", {})["delay"]["attributes"];
  const double samples = 48e3 * delay["delay"].get<double>();
  CHECK(samples == Approx(123).margin(0.01));
}

TEST_CASE("the round trip as measured is taken out of what is captured") {
  const SoundCardBench bench("delay 123 noise 1e-4 " + kSection);
  const auto results = bench.measure("sound_card.yaml", {"round_trip=123"});
  CHECK(inside(results["response"], 0) >= 162);
  CHECK(results["card"]["attributes"]["round_trip_delay"] == 123);
}

TEST_CASE("the corner of the AC coupling is measured by its graph") {
  // One pole at 20 Hz, one zero at 0: 0.9973854 = exp(-2 pi 20 / 48000).
  const SoundCardBench bench("delay 5 noise 1e-4 b [ 0.9986927 -0.9986927 0.0 ] a [ -0.9973854 0.0 ]");
  const auto model = bench.measure("sound_card_coupling.yaml", {"period=9600", "round_trip=5"}, 3)["coupling"];
  const auto& arrays = model["arrays"];
  const Complex pole(arrays["poles"]["data"][0][0], arrays["poles"]["data"][0][1]);
  CHECK(std::abs(pole) / (2 * std::numbers::pi) == Approx(20).margin(0.3));
}

TEST_CASE("overruns and underruns injected into a measurement are counted exactly and it goes on") {
  const SoundCardBench bench("delay 37 noise 1e-4 overruns [ 9000 20000 41000 ] underruns [ 15000 30000 ] " + kSection);
  const auto results = bench.measure("sound_card.yaml", {"blocks.card.on_gap=mark"});
  const auto& device = results["card"]["attributes"];
  CHECK(device["overruns"] == 3);
  CHECK(device["underruns"] == 2);
  CHECK(device["samples"] == 13 * 4800);
  CHECK(results["card.gaps"]["type"] == "gap");
  CHECK(results["card.gaps"]["attributes"]["cause"] == "overrun");
}

TEST_CASE("what is captured answers what is played sample by sample on each channel behind an overrun too") {
  const SoundCardBench bench("delay 20 overruns [ 15000 ]");
  const auto graph = bench.folder.write(
      "stereo.yaml",
      "bodeflow: 1\nrun: {clock: realtime, chunk: 300, duration: 0.6 s, seed: 1}\nblocks:\n"
      "  u: {block: generators.multisine, sample_rate: 48 kHz, period: 4800, lines: {first: 1, last: 2000}, inputs: 2, "
      "experiment_periods: 4, rms: 0.1}\n"
      "  card: {block: acquisition.alsa_duplex, device: loop, buffer: 65536, lead: 9000, on_gap: mark, capture: {channels: 2}}\n"
      "  file: {block: output.csv, file: x.csv}\n"
      "  other: {block: output.csv, file: y.csv}\n"
      "connections:\n  - u -> card\n  - card.played -> file\n  - card.captured -> other\n");
  const auto results = bench.results({graph.string()});
  const auto position = results["card.gaps"]["attributes"]["position"].get<std::size_t>();
  for (const std::size_t channel : {1, 2}) {
    const auto played = column(bench.folder.read("out/x.csv"), channel),
               captured = column(bench.folder.read("out/y.csv"), channel);
    REQUIRE(captured.size() == 28800);
    REQUIRE(played.size() == 28800);
    std::size_t wrong = 0, loud = 0;
    for (std::size_t n = 0; n < captured.size(); ++n) {
      const bool begun = n >= 20 && (n < position || n >= position + 20);
      wrong += std::abs(captured[n] - (begun ? played[n - 20] : 0.0)) > 0x1p-31;
      loud += std::abs(played[n]) > 0.01;
    }
    CHECK(wrong == 0);
    CHECK(loud > 10000);
  }
}

TEST_CASE("an overrun of a capture is marked at its place with the samples that are missing") {
  const SoundCardBench bench("ramp 1 overruns [ 6000 12000 ]");
  const auto results = bench.results({bench.capture("on_gap: mark")});
  CHECK(results["adc"]["attributes"]["overruns"] == 2);

  std::vector<long> ramp;
  for (const double value : column(bench.folder.read("out/x.csv"), 1)) ramp.push_back(std::lround(32768 * value));
  REQUIRE(ramp.size() == 24000);
  std::map<std::size_t, long> jumps;
  for (std::size_t n = 1; n < ramp.size(); ++n)
    if (const long step = (ramp[n] - ramp[n - 1] + 32768) % 32768; step != 1) jumps[n] = step - 1;

  std::istringstream lines(bench.folder.read("out/gaps.jsonl"));
  std::string row;
  std::size_t marked = 0;
  while (std::getline(lines, row)) {
    const auto gap = json::parse(row)["attributes"];
    INFO(gap.dump());
    const auto jump = jumps.find(gap["position"].get<std::size_t>());
    REQUIRE(jump != jumps.end());
    CHECK(std::labs(jump->second - gap["missing"].get<long>()) <= 24);  // 0.5 ms: the time that starting takes
    ++marked;
  }
  CHECK(marked == 2);
  CHECK(jumps.size() == 2);
}

TEST_CASE("an overrun ends a run that does not mark it: block, place, cause") {
  const SoundCardBench bench("overruns [ 6000 ]");
  const Ended ended = bench.run({bench.capture("on_gap: end")});
  CHECK(ended.exit_code == 5);
  CHECK_THAT(ended.err,
             Contains("block 'adc': overrun before sample ") && Contains("the samples were not taken in time; raise buffer"));
  CHECK(json::parse(bench.folder.read("out/result.json"))["status"] == "failed");
}

TEST_CASE("a device that ends a run of a sweep gives the exit code of a device") {
  const SoundCardBench bench("overruns [ 3000 ]");
  const auto graph = bench.folder.write(
      "sweep.yaml",
      "bodeflow: 1\nphases:\n  - name: several\n    run: {clock: realtime, chunk: 256, duration: 0.2 s}\n    blocks:\n"
      "      adc: {block: acquisition.alsa_capture, device: loop, rate: 48 kHz, buffer: 65536, on_gap: end}\n"
      "      file: {block: output.csv, file: x.csv}\n    connections:\n      - adc -> file\n"
      "    sweep: {seed: 1..2}\n");
  const Ended ended = bench.run({graph.string()});
  CHECK(ended.exit_code == 5);
  CHECK_THAT(ended.err, Contains("of the sweep failed: block 'adc': overrun before sample "));
}

TEST_CASE("a device that breaks off at each start ends a run that marks gaps") {
  const SoundCardBench bench("overruns [ 0 0 0 0 0 0 0 0 0 0 ]");
  CHECK_THAT(bench.run({bench.capture("on_gap: mark")}).err,
             Contains("block 'adc': the device breaks off at each start, 8 times in a row"));
}

TEST_CASE("a device that stops delivering ends the run after its timeout") {
  const SoundCardBench bench("stall 5000");
  const Ended ended = bench.run({bench.capture("timeout: 200 ms")});
  CHECK(ended.exit_code == 5);
  CHECK_THAT(ended.err, Contains("block 'adc': sound device 'loop' (capture) delivered nothing for 0.2 s"));
}

TEST_CASE("what a sound device can't do is refused with what it can") {
  const SoundCardBench bench("");
  const Variable config("ALSA_CONFIG_PATH", bench.folder.path() / "asound.conf");
  const auto said = [](const std::function<void(PcmSpec&)>& change) {
    PcmSpec spec;
    spec.device = "loop";
    change(spec);
    const auto pcm = Pcm::open(spec);
    return pcm ? std::string("no refusal") : pcm.error().text;
  };
  CHECK(said([](PcmSpec&) {}) == "no refusal");
  CHECK(said([](PcmSpec& s) { s.format = SampleFormat::s24; }) ==
        "sound device 'loop' (capture) has no format s24; allowed: s16, s32");
  CHECK(said([](PcmSpec& s) { s.channels = 9; }) ==
        "sound device 'loop' (capture) does not run with 9 channels; allowed: 1 to 4");
  CHECK(said([](PcmSpec& s) { s.rate_hz = 44100; }) ==
        "sound device 'loop' (capture) does not run at 44100 Hz; allowed: rates of its own from 8000 to 96000 Hz");
  CHECK(said([](PcmSpec& s) {
          s.device = "nowhere";
          s.direction = Direction::playback;
        }) == "sound device 'nowhere' (playback) can't be opened: No such file or directory; `aplay -l` lists what there is");
  CHECK_THAT(bench.run({bench.capture("period: 65536")}).err,
             Contains("a buffer of 65536 frames with a period of 65536; allowed: at least two periods"));
}

TEST_CASE("a device is refused in simulated time") {
  const SoundCardBench bench("");
  const Ended ended = bench.run({bench.capture("format: s16", "0.1 s", "simulated")});
  CHECK(ended.exit_code == 5);
  CHECK_THAT(ended.err,
             Contains("block 'adc': a device goes by real time; run: {clock: simulated} does not. Allowed: realtime, hardware"));
}

TEST_CASE("a calibration file makes physical values of each channel") {
  const SoundCardBench bench("ramp 1");
  bench.folder.write("cal.csv", "# bench 3\nchannel, gain, offset, unit, date\nch2, 0.5, 1, A, today\nch1, -2, 0, V, today\n");
  const auto results = bench.results({bench.capture("channels: 2, format: s16, calibration: cal.csv", "0.05 s")});
  std::istringstream rows(bench.folder.read("out/x.csv"));
  std::string row;
  std::getline(rows, row);
  CHECK_THAT(row, Contains("ch1 [V]") && Contains("ch2 [A]"));
  std::getline(rows, row);
  std::getline(rows, row);
  double time = 0, first = 0, second = 0;
  REQUIRE(std::sscanf(row.c_str(), "%lf,%lf,%lf", &time, &first, &second) == 3);
  CHECK(second == Approx(1 - 0.25 * first).epsilon(1e-12));
  CHECK(first < 0);

  bench.folder.write("cal.csv", "channel,gain\nch1,1\nch2,0\n");
  CHECK_THAT(bench.run({bench.capture("channels: 2, calibration: cal.csv")}).err,
             Contains("cal.csv:3:5: a gain of 0; allowed: any other number"));
}

TEST_CASE("samples played by a playback block alone all leave the device and limited ones are counted") {
  const SoundCardBench bench("");
  const auto graph = bench.folder.write(
      "play.yaml",
      "bodeflow: 1\nrun: {clock: realtime, chunk: 256, duration: 0.25 s}\nblocks:\n"
      "  sine: {block: generators.sine, sample_rate: 48 kHz, frequency: 1 kHz, amplitude: 2.2, unit: V}\n"
      "  dac: {block: acquisition.alsa_playback, device: loop, buffer: 16384, scale: 2, unit: V, format: s16}\n"
      "connections:\n  - sine -> dac\n");
  const auto device = bench.results({graph.string()})["dac"]["attributes"];
  CHECK(device["samples"] == 12000);
  CHECK(device["underruns"] == 0);
  CHECK(device["lead"] == 16384 - 256);
  CHECK(device["clipped"].get<int>() > 3000);  // a third of a sine is above 2 / 2.2 of its peak
  CHECK_THAT(bench.run({graph.string(), "--set", "blocks.sine.unit=A"}).err,
             Contains("channel 1 of the input is in A, its scale in V"));
}

TEST_CASE("underruns of a playback are counted exactly") {
  const SoundCardBench bench("underruns [ 3000 6000 ]");
  const auto graph =
      bench.folder.write("play.yaml",
                         "bodeflow: 1\nrun: {clock: realtime, chunk: 256, duration: 0.3 s}\nblocks:\n"
                         "  sine: {block: generators.sine, sample_rate: 48 kHz, frequency: 1 kHz}\n"
                         "  dac: {block: acquisition.alsa_playback, device: loop, buffer: 16384, lead: 12000, on_gap: mark}\n"
                         "connections:\n  - sine -> dac\n");
  const auto results = bench.results({graph.string()});
  CHECK(results["dac"]["attributes"]["underruns"] == 2);
  CHECK(results["dac.gaps"]["attributes"]["cause"] == "underrun");
}

TEST_CASE("a lead that the round trip outlasts is refused, and lines that the coupling turns are warned of") {
  const SoundCardBench bench("");
  CHECK_THAT(bench.run({kSoundCardGraphs + "sound_card.yaml", "--set", "device=loop", "--set", "round_trip=3000"}).err,
             Contains("the playback would run dry; raise lead to 3512 or more"));
  CHECK_THAT(run_bodeflow({"check", kSoundCardGraphs + "sound_card.yaml", "--set", "ac_corner=12 Hz"}).err,
             Contains("the line at 100 Hz lies below ten times the corner of the AC coupling, 12 Hz"));
}

TEST_CASE("Ctrl-C ends a run on a device at once and keeps what it gave") {
  const SoundCardBench bench("ramp 1");
  const std::string graph = bench.capture("format: s16", "60 s");
  // Interrupted as soon as there is something to keep.
  const std::string command =
      "\"$0\" run \"$1\" --out out & n=0; while [ ! -s out/x.csv ] && [ $n -lt 400 ]; do sleep 0.05; n=$((n + 1)); done; "
      "kill -INT $!; wait $!";
  const auto ended =
      bodeflow::test::run_program({"sh", "-c", command, BODEFLOW_BUILD_DIR "/bin/bodeflow", graph}, bench.folder.path(),
                                  {"ALSA_CONFIG_PATH=" + (bench.folder.path() / "asound.conf").string()});
  INFO(ended.err);
  CHECK(ended.exit_code == 130);
  const auto kept = column(bench.folder.read("out/x.csv"), 1).size();
  CHECK(kept > 100);
  CHECK(kept < 48000 * 30);
}
