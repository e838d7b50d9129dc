// `bodeflow compare BEFORE AFTER` on frequency responses, and the graphs of changes and of orders.

#include <cmath>
#include <complex>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using namespace bodeflow::test;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Two modes, the second at `f2`, of 60 lines from 10 to 1000 Hz, as a file.
std::string response_csv(double f2, bool with_deviation = true) {
  std::string text = with_deviation ? "f [Hz],re(G),im(G),std(G)\n" : "f [Hz],re(G),im(G)\n";
  for (int k = 0; k < 60; ++k) {
    const double f = 10.0 * std::pow(100.0, k / 59.0);
    std::complex<double> g = 0.0;
    for (const double own : {60.0, f2}) g += own * own / std::complex<double>(own * own - f * f, 0.2 * own * f);
    char line[200];
    std::snprintf(line, sizeof line, with_deviation ? "%.12g,%.12g,%.12g,1e-3\n" : "%.12g,%.12g,%.12g\n", f, g.real(), g.imag());
    text += line;
  }
  return text;
}

Json change_in(const Folder& folder, const std::string& out = "out") {
  return Json::parse(folder.read(out + "/result.json"))["results"]["compare"];
}

fs::path loudspeaker(const std::string& file) {
  const char* given = std::getenv("BODEFLOW_DATA");
  const fs::path data = given != nullptr ? fs::path(given) : fs::path(BODEFLOW_SOURCE_DIR) / ".." / "shared" / "data";
  return fs::absolute(data / "loudspeaker_impedance" / file);
}

/// Of the mode near 46 Hz: the factor of the mass that moves, and its deviation.
struct Inertia {
  double ratio = 0.0, deviation = 0.0, shift = 0.0, shift_deviation = 0.0;
};

Inertia inertia_of(const Json& change) {
  const Json& arrays = change["arrays"];
  const Json& before = arrays["mode_frequency_before"]["data"];
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!before[i].is_number() || std::abs(before[i].get<double>() - 46.0) > 3.0) continue;
    CHECK(change["attributes"]["mode_status"][i] == "moved");
    const auto of = [&](const char* name) { return arrays[name]["data"][i].get<double>(); };
    return {of("mode_inertia_ratio"), of("mode_inertia_ratio_deviation"), of("mode_frequency_shift"),
            of("mode_frequency_shift_deviation")};
  }
  FAIL("no resonance near 46 Hz");
  return {};
}

}  // namespace

TEST_CASE("compare tells what has changed between two files of frequency responses") {
  const Folder folder;
  folder.write("before.csv", response_csv(300.0));
  folder.write("after.csv", response_csv(309.0));
  const auto ended = run_bodeflow({"compare", "before.csv", "after.csv", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(ended.out.find("moved") != std::string::npos);
  CHECK(ended.out.find("scatter of repeat tests: unknown") != std::string::npos);
  const Json change = change_in(folder);
  CHECK(change["attributes"]["verdict"] == "changed");
  CHECK(change["attributes"]["mode_status"] == Json({"same", "moved"}));
  CHECK(change["arrays"]["mode_frequency_shift"]["data"][1].get<double>() == Approx(0.03).margin(1e-3));
  CHECK(folder.read("out/report.html").find("What has changed from before.csv to after.csv") != std::string::npos);
}

TEST_CASE("compare takes responses of runs, repeats and a stated scatter") {
  const Folder folder;
  folder.write("before.csv", response_csv(300.0, false));
  folder.write("repeat.csv", response_csv(300.3, false));
  const auto run = run_bodeflow({"compare", "before.csv", "before.csv", "--scatter", "1 %", "--out", "same"}, folder.path());
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  CHECK(change_in(folder, "same")["attributes"]["verdict"] == "unchanged");
  folder.write(
      "graph.yaml",
      "bodeflow: 1\ntitle: t\nrun: {clock: simulated}\nblocks:\n  response: {block: acquisition.frequency_response, file: "
      "before.csv}\n  keep: {block: output.records, file: kept.jsonl}\nconnections:\n  - response -> keep\n");
  REQUIRE(run_bodeflow({"run", "graph.yaml", "--out", "first"}, folder.path()).exit_code == 0);
  const auto ended = run_bodeflow({"compare", "first", "before.csv", "--repeat", "repeat.csv", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(change_in(folder)["attributes"]["scatter"] == "from 1 repeat test");
  CHECK(change_in(folder)["attributes"]["verdict"] != "changed");
}

TEST_CASE("compare refuses responses beside models and more than two responses") {
  const Folder folder;
  folder.write("a.csv", response_csv(300.0));
  folder.write("text.csv", "t [s],u,y\n0,1,2\n1,2,3\n2,3,4\n");
  folder.write("model.json", R"({"bodeflow": 1, "results": {"m": {"type": "model", "attributes": {}, "arrays": {}}}})");
  const auto refused = [&](std::vector<std::string> words, int code) {
    words.insert(words.begin(), "compare");
    const auto ended = run_bodeflow(words, folder.path());
    CHECK(ended.exit_code == code);
    return ended.err;
  };
  CHECK(refused({"a.csv", "model.json"}, 3).find("a.csv is a frequency response, model.json is not") != std::string::npos);
  CHECK(refused({"a.csv", "a.csv", "a.csv"}, 2).find("3 frequency responses; needed: two") != std::string::npos);
  CHECK(refused({"a.csv", "text.csv"}, 3).find("neither a frequency response nor a run") != std::string::npos);
  CHECK(refused({"a.csv", "a.csv", "--data", "text.csv"}, 2).find("--data belongs to models") != std::string::npos);
}

TEST_CASE("a loudspeaker with masses added: shifts of the resonance with intervals, and the masses that they mean") {
  if (!fs::exists(loudspeaker("L16RNX_0g.csv"))) {
    std::cout << "skipped: needs " << loudspeaker("L16RNX_0g.csv").string() << " (set BODEFLOW_DATA)\n";
    return;
  }
  const auto measured = [](const char* file) {
    const Folder folder;
    const auto ended = run_bodeflow({"compare", loudspeaker("L16RNX_0g.csv").string(), loudspeaker(file).string(), "--scatter",
                                     "1 %", "--set", "pairing=0.5", "--out", "out"},
                                    folder.path());
    INFO(ended.err);
    REQUIRE(ended.exit_code == 0);
    CHECK(change_in(folder)["attributes"]["verdict"] == "changed");
    return inertia_of(change_in(folder));
  };
  const Inertia light = measured("L16RNX_8p017g.csv"), heavy = measured("L16RNX_16p048g.csv");
  CHECK(light.shift == Approx(-0.200).margin(0.005));
  CHECK(heavy.shift == Approx(-0.318).margin(0.005));
  CHECK(light.shift_deviation < 0.003);
  // The mass that moves from the known 8.017 g; the second shift then weighs the second mass, which is 16.048 g.
  const double moving = 8.017 / (light.ratio - 1.0), second = moving * (heavy.ratio - 1.0);
  const double relative = std::hypot(light.deviation / (light.ratio - 1.0), heavy.deviation / (heavy.ratio - 1.0));
  std::cout << "moving mass " << moving << " g; second mass " << second << " +- " << 1.96 * relative * second
            << " g, weighed 16.048 g\n";
  CHECK(std::abs(second - 16.048) < 3.0 * relative * second);
  CHECK(moving == Approx(14.2).margin(0.5));
}

TEST_CASE("the transformer before and after: one mode gone, one new, one moved, two phases as they were") {
  const Folder folder;
  const auto ended = run_bodeflow({"run", BODEFLOW_SOURCE_DIR "/graphs/akcay_1999/transformer_before_after.yaml", "--out", "out"},
                                  folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const Json results = Json::parse(folder.read("out/result.json"))["results"];
  CHECK(results["phase_a"]["attributes"]["verdict"] == "changed");
  const Json& status = results["phase_a"]["attributes"]["mode_status"];
  CHECK(status == Json({"same", "moved", "same", "vanished", "new", "same", "same"}));
  for (const char* phase : {"phase_b", "phase_c"}) CHECK(results[phase]["attributes"]["verdict"] == "unchanged");
}
