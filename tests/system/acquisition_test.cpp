#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Complex = std::complex<double>;

namespace {

nlohmann::json results(const Folder& folder, const std::string& graph, std::vector<std::string> options, std::string& said) {
  std::vector<std::string> words{"run", graph, "--out", "out"};
  words.insert(words.end(), options.begin(), options.end());
  const auto ended = run_bodeflow(words, folder.path());
  said = ended.err;
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return nlohmann::json::parse(folder.read("out/result.json"))["results"];
}

const std::string kMeasuring = BODEFLOW_SOURCE_DIR "/graphs/measuring/";

}  // namespace

TEST_CASE("a graph of records alone runs without streams and without a duration") {
  const Folder folder;
  std::string said;
  const auto impedance = results(folder, kMeasuring + "imported_response.yaml", {}, said)["impedance"];
  CHECK(impedance["type"] == "frequency_response");
  CHECK(impedance["attributes"]["form"] == "imported");
  CHECK(impedance["attributes"]["response_units"] == nlohmann::json{"ohm"});
  CHECK(impedance["arrays"]["response"]["shape"] == nlohmann::json{61, 1, 1});
  const Complex first = std::polar(3.30747, 52.0215 * std::numbers::pi / 180);
  CHECK(impedance["arrays"]["response"]["data"][0][0].get<double>() == Approx(first.real()).epsilon(1e-12));
  CHECK(impedance["arrays"]["variance"]["data"][0].get<double>() == Approx(0.0165 * 0.0165).epsilon(1e-12));
  CHECK(said.find("61 points, 10 to 100000 Hz, logarithmic grid") != std::string::npos);
  CHECK(folder.read("out/impedance.jsonl").find("\"frequency_response\"") != std::string::npos);
}

TEST_CASE("converters with equal anti-alias filters leave the response of a plant within its confidence circles") {
  const Folder folder;
  std::string said;
  const auto response = results(folder, kMeasuring + "adc.yaml", {}, said)["response"]["arrays"];
  const auto frequency = response["frequency"]["data"].get<std::vector<double>>();
  REQUIRE(frequency.size() == 200);
  int inside = 0;
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    // The plant at 200 kHz, its input held over each sample: its delay of half a sample is in the data.
    const Complex s(0.0, 2 * std::numbers::pi * frequency[k]), z = s / 200e3;
    const Complex truth = 39478417.6 / (s * s + 2513.27412 * s + 39478417.6) * (1.0 - std::exp(-z)) / z;
    const auto& g = response["response"]["data"][k];
    inside += std::abs(Complex(g[0], g[1]) - truth) <= response["confidence_radius"]["data"][k].get<double>();
  }
  CHECK(inside >= 180);  // 95 % of 200, less 3.2 standard deviations
}

TEST_CASE("a converter whose range is too small tells how much it clipped") {
  const Folder folder;
  std::string said;
  results(folder, kMeasuring + "adc.yaml", {"--set", "blocks.adc_y.range=[-1, 1]"}, said);
  CHECK(said.find("warning: adc_y: clipped ") != std::string::npos);
}

TEST_CASE("a resampler joins two clocks in a graph, and without it the join is refused by name") {
  const Folder folder;
  const auto graph = [&](const std::string& second) {
    return folder
        .write("clocks.yaml",
               "bodeflow: 1\nrun: {clock: simulated, duration: 1 s}\nblocks:\n"
               "  a: {block: generators.sine, sample_rate: 1 kHz, frequency: 10 Hz}\n"
               "  b: {block: generators.sine, sample_rate: 800 Hz, frequency: 10 Hz}\n"
               "  there: {block: acquisition.resample, rate: 1 kHz, clock: scope}\n"
               "  back: {block: acquisition.resample, rate: 1 kHz, clock: \"\"}\n"
               "  sum: {block: filters.sum}\nconnections:\n  - a -> sum.a\n  - b -> there\n  - " +
                   second + "\n")
        .string();
  };
  CHECK(run_bodeflow({"check", graph("there -> back -> sum.b")}, folder.path()).exit_code == 0);
  const auto refused = run_bodeflow({"check", graph("there -> sum.b\n  - there -> back")}, folder.path());
  CHECK(refused.exit_code == 3);
  CHECK(refused.err.find("sum.a runs on the engine's clock (a.out), sum.b on clock 'scope' (there.out); needs a resampler") !=
        std::string::npos);
}
