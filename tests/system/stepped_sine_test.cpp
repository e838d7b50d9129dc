#include <algorithm>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Complex = std::complex<double>;

namespace {

constexpr double kRate = 64.0;

/// The response of the graphs' plant: modes of 2, 5 and 9 rad/s, the input held over each sample.
Complex truth(double frequency) {
  const Complex z = std::polar(1.0, 2.0 * std::numbers::pi * frequency / kRate);
  Complex g = 0.0;
  for (const auto& [omega, damping] : {std::pair{2.0, 0.02}, {5.0, 0.03}, {9.0, 0.01}}) {
    const Complex pole = omega * Complex(-damping, std::sqrt(1.0 - damping * damping));
    for (const Complex p : {pole, std::conj(pole)}) {
      const Complex e = std::exp(p / kRate), residue = omega * omega / (p - std::conj(p));
      g += residue * (e - 1.0) / (p * (z - e));
    }
  }
  return g;
}

nlohmann::json run(const Folder& folder, const std::string& graph, std::vector<std::string> options, const std::string& file) {
  std::vector<std::string> words{"run", std::string(BODEFLOW_SOURCE_DIR "/graphs/measuring/") + graph, "--out", "out"};
  words.insert(words.end(), options.begin(), options.end());
  const auto ended = run_bodeflow(words, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return nlohmann::json::parse(folder.read("out/" + file));
}

/// ||G - Ghat|| / ||G|| of a frequency response in result.json, and the share of lines whose circle holds the truth.
std::pair<double, double> errors(const nlohmann::json& arrays) {
  double error = 0.0, power = 0.0, inside = 0.0;
  const auto frequency = arrays["frequency"]["data"].get<std::vector<double>>();
  for (std::size_t k = 0; k < frequency.size(); ++k) {
    const auto& g = arrays["response"]["data"][k];
    const double off = std::abs(Complex(g[0], g[1]) - truth(frequency[k]));
    error += off * off;
    power += std::norm(truth(frequency[k]));
    inside += off <= arrays["confidence_radius"]["data"][k].get<double>();
  }
  return {std::sqrt(error / power), inside / static_cast<double>(frequency.size())};
}

}  // namespace

TEST_CASE("a stepped sine closed by records measures each frequency for as long as it needs") {
  const Folder folder;
  const auto response = run(folder, "stepped_sine.yaml", {}, "result.json")["results"]["response"];
  const auto& arrays = response["arrays"];
  const auto dwell = arrays["dwell"]["data"].get<std::vector<double>>();
  REQUIRE(dwell.size() == 40);
  CHECK(response["attributes"]["warnings"].empty());
  const auto [error, inside] = errors(arrays);
  CHECK(error < 5e-4);
  CHECK(inside > 0.8);
  CHECK(*std::min_element(dwell.begin(), dwell.end()) < 60.0);
  CHECK(*std::max_element(dwell.begin(), dwell.end()) > 150.0);
}

TEST_CASE("a stepped sine closed by records is the same for any chunk and thread count") {
  const std::vector<std::string> shorter{"--set", "excitation.grid.count=6"};
  const auto hashes = [&](const char* chunk, const char* threads) {
    const Folder folder;
    auto options = shorter;
    options.insert(options.end(), {"--set", std::string("run.chunk=") + chunk, "--threads", threads});
    return run(folder, "stepped_sine.yaml", options, "manifest.json")["hashes"];
  };
  const auto first = hashes("1", "1");
  REQUIRE_FALSE(first.empty());
  for (const char* chunk : {"7", "64", "1000"}) CHECK(hashes(chunk, "1") == first);
  for (const char* threads : {"2", "4"}) CHECK(hashes("256", threads) == first);
}

TEST_CASE("in the same time a multisine has the smaller error, and the stepped sine says what had not settled") {
  const Folder folder;
  const auto results = run(folder, "stepped_sine_and_multisine.yaml", {}, "result.json")["results"];
  const auto [stepped, stepped_inside] = errors(results["stepped"]["arrays"]);
  const auto [multi, multi_inside] = errors(results["multi"]["arrays"]);
  CHECK(multi < 1e-4);
  CHECK(multi < stepped);
  CHECK(multi_inside > 0.85);
  CHECK_FALSE(results["stepped"]["attributes"]["warnings"].empty());
}
