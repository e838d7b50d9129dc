// The plugin that is pinned to ABI 1.0 loads here and gives its numbers.
#include <algorithm>
#include <bodeflow/parts.hpp>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "plugins/sha256.hpp"
#include "runtime/plugins/shelf.hpp"
#include "system/command.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

const std::filesystem::path kPlugin = BODEFLOW_PINNED_PLUGIN;

std::string graph(int chunk, int threads) {
  return "bodeflow: 1\n"
         "run: {clock: simulated, duration: 2 s, chunk: " +
         std::to_string(chunk) + ", threads: " + std::to_string(threads) +
         "}\n"
         "blocks:\n"
         "  ramp: {block: pinned.ramp, length: 1000}\n"
         "  scale: {block: pinned.scale, file: notes.txt, temper: wild, group: {integers: [4, 6]}}\n"
         "  delay: {block: pinned.delay}\n"
         "  pair: {block: pinned.pair}\n"
         "  sum: {block: pinned.sum}\n"
         "connections:\n"
         "  - ramp.out -> scale -> delay -> pair -> sum\n"
         "  - ramp.marks -> scale.mark\n"
         "schedule:\n"
         "  - {at: 0.5 s, block: scale, set: {gain: 3}}\n";
}

/// What comes out of the chain: sums of the complex samples of a channel, real and imaginary part.
std::pair<double, double> expected(double sign) {
  std::vector<double> y{7, 8};
  for (int n = 0; n < 1000; ++n) y.push_back((n < 500 ? 2.5 : 3.0) * sign * n + 100 * (n / 100));
  std::pair<double, double> sums;
  for (int k = 0; k < 500; ++k) sums.first += y[2 * k], sums.second += y[2 * k + 1];
  return sums;
}

}  // namespace

TEST_CASE("pinned: neither the header nor the plugin of ABI 1.0 was touched") {
  const std::filesystem::path folder = BODEFLOW_SOURCE_DIR "/tests/contract/pinned";
  CHECK(sha256_of_file(folder / "abi_1_0.h").value() == "8f21b662ad396c9ba86996b8d6d319d963d1ed7f372229ae461cb31cbedc9f6c");
  CHECK(sha256_of_file(folder / "pinned.c").value() == "17dee810f1664e318a90afc490762ee060570ff0b08926964f6b261951105ffc");
}

TEST_CASE("pinned: the plugin runs, bit for bit, however it is cut") {
  const Folder folder;
  folder.write("notes.txt", "an input");
  const auto [chunk, threads] = GENERATE(std::pair{256, 1}, std::pair{1, 1}, std::pair{37, 2});
  folder.write("graph.yaml", graph(chunk, threads));
  const Ended ended =
      run_bodeflow({"--path", kPlugin.parent_path().string(), "run", "graph.yaml", "--out", "run"}, folder.path());
  INFO(ended.out << ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto result = nlohmann::json::parse(folder.read("run/result.json"))["results"]["sum"];
  CHECK(result["attributes"]["value"] == 500.0);
  const auto [up_re, up_im] = expected(1.0);
  const auto [down_re, down_im] = expected(-1.0);
  CHECK(result["arrays"]["sums"]["unit"] == "V");
  CHECK(result["arrays"]["sums"]["data"] == nlohmann::json{{up_re, up_im}, {down_re, down_im}});
  CHECK(folder.read("run/pinned.txt") == "500/1 Hz\n");
  CHECK(folder.read("run/log.txt")
            .find("flag 1 count 7 name pinned mood wild times 1.5 -2 integers 4 6 texts one two complex 1-1i "
                  "0.5+2i matrix 2x3 6") != std::string::npos);
  CHECK(ended.err.find("sums 2 channels in V, period 0.25 s") != std::string::npos);
  CHECK(folder.read("run/manifest.json").find("notes.txt") != std::string::npos);
}

TEST_CASE("pinned: the conformance suite finds nothing") {
  const Folder folder;
  folder.write("settings.txt", "pinned.ramp: length = 300\n");
  const Ended ended = run_bodeflow({"test-plugin", kPlugin.string(), "--settings", "settings.txt"}, folder.path());
  INFO(ended.out << ended.err);
  CHECK(ended.exit_code == 0);
}

TEST_CASE("pinned: the effect and the base model are there") {
  const Shelf shelf({kPlugin});
  CHECK(shelf.refused.empty());
  const auto drag = shelf.parts().effect("pinned.drag");
  Situation situation;
  situation.place.name = "rail";
  situation.place.reaction_unit = "N";
  situation.line_hz = {1.0, 2.0};
  CHECK(drag->parameters(situation).at(0).unit == "N");
  CHECK(drag->starts(situation) == std::vector<std::vector<double>>{{0.5}, {2.0}});
  const std::vector<double> value{2.5};
  CHECK(drag->sentence(value, value, situation) == "drag of 2.5 N at the rail");
  Signals signals;
  signals.flow = 3.0, signals.step_s = 0.5;
  const double memory = 1.0;
  double next = 0.0;
  CHECK(drag->react(value.data(), signals, &memory, &next).value == 7.5);
  CHECK(next == 1.5);
  situation.input_peak = 101.0;
  CHECK(drag->refuses(situation) == "the input is too large");

  const auto cart = shelf.parts().base_model("pinned.cart", {"delay=2 ms"});
  CHECK(cart->timing().delay_s == 2e-3);
  CHECK(cart->places().at(0).kind == "bearing");
  LinearPlant plant;
  const double mass = 4.0;
  REQUIRE(cart->state_space(&mass, nullptr, plant));
  CHECK(plant.B == std::vector<double>{0.25});
  CHECK(plant.E == std::vector<double>{-0.25});
  MeasuredResponse measured;
  measured.frequency_hz = {7.0, 8.0};
  CHECK(cart->starts({&measured, 1}) == std::vector<std::vector<double>>{{7.0}});
}
