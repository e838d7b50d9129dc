#include <nlohmann/json.hpp>

#include "bench_data.hpp"
#include "catch.hpp"
#include "system/command.hpp"

using namespace bodeflow::test;
using Words = std::vector<std::string>;

namespace {

void identify(const Folder& folder, const std::string& data, const std::string& run) {
  const auto ended = run_bodeflow({"identify", data, "--input", "voltage", "--output", "current", "--method", "koopmans_levin",
                                   "--order", "2", "--set", "ratio=1", "--out", run},
                                  folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
}

nlohmann::json comparison_in(const Folder& folder) {
  return nlohmann::json::parse(folder.read("out/result.json"))["results"]["compare"];
}

std::string refusal(const Folder& folder, const Words& words, int code) {
  const auto ended = run_bodeflow(words, folder.path());
  INFO(ended.err);
  CHECK(ended.exit_code == code);
  CHECK(ended.out.empty());
  return ended.err;
}

bool holds(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return true;
  UNSCOPED_INFO("'" << part << "' is not in:\n" << text);
  return false;
}

/// model.json as a run with a model by hand leaves it: y[n] = 1.5 y[n-1] - 0.7 y[n-2] + 0.4 u[n-1] + 0.2 u[n-2].
std::string exact_model(double amplitude) {
  return R"({"bodeflow": 1, "status": "complete", "results": {"identify": {"type": "model", "attributes": {
    "method": "hand", "form": "transfer_function", "order": 2, "sample_time": 0.01, "parameter_names": ["a1", "a2"],
    "band": [0.0, 50.0], "input_amplitude": )" +
         std::to_string(amplitude) + R"(}, "arrays": {
    "parameters": {"unit": "", "shape": [2], "data": [-1.5, 0.7]},
    "numerator": {"unit": "", "shape": [2], "data": [0.4, 0.2]},
    "denominator": {"unit": "", "shape": [3], "data": [1.0, -1.5, 0.7]}}}}})";
}

}  // namespace

TEST_CASE("compare holds an exact model against noise-free data with a fit of 100 percent") {
  const Folder folder;
  BenchData clean;
  clean.noise = 0.0;
  folder.write("bench.csv", bench_csv(clean));
  folder.write("model.json", exact_model(3.4));
  const auto ended = run_bodeflow({"compare", "model.json", "--data", "bench.csv", "--input", "voltage", "--output", "current",
                                   "--out", "out", "--set", "data.start=1000"},
                                  folder.path());
  CHECK(ended.exit_code == 3);  // data is no parameter of the comparison
  const auto plain = run_bodeflow({"compare", "model.json", "--data", "bench.csv", "--input", "voltage", "--output", "current",
                                   "--steps", "5", "--out", "out"},
                                  folder.path());
  INFO(plain.err);
  REQUIRE(plain.exit_code == 0);
  const auto record = comparison_in(folder);
  CHECK(record["type"] == "comparison");
  CHECK(record["attributes"]["models"] == nlohmann::json{"model.json"});
  CHECK(record["attributes"]["steps"] == 5);
  CHECK(record["attributes"]["estimated"] == "initial state and output offset, from these data");
  CHECK(record["arrays"]["fit"]["data"][0].get<double>() == Approx(100.0).margin(1e-9));
  CHECK(record["arrays"]["prediction_fit"]["data"][0].get<double>() == Approx(100.0).margin(1e-9));
  CHECK(holds(plain.out, "5-step [%]"));
  CHECK(holds(plain.out, "out/report.html"));
  CHECK(holds(folder.read("out/report.html"), "Measured and simulated output"));
}

TEST_CASE("compare sets models of two runs side by side and tells how far apart they are") {
  const Folder folder;
  folder.write("a.csv", bench_csv());
  folder.write("b.csv", bench_csv({3000, 2, 0.1, 1.0, 0}));
  identify(folder, "a.csv", "first");
  identify(folder, "b.csv", "second");
  const auto ended = run_bodeflow({"compare", "first", "second/result.json", "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  const auto record = comparison_in(folder);
  CHECK(record["attributes"]["models"] == nlohmann::json{"first", "second"});
  CHECK_FALSE(record["arrays"].contains("fit"));
  const auto shape = record["arrays"]["parameter_difference"]["shape"].get<std::vector<std::size_t>>();
  REQUIRE(shape[0] == 2);
  for (std::size_t i = 0; i < shape[1]; ++i)
    CHECK(std::abs(record["arrays"]["parameter_difference"]["data"][shape[1] + i].get<double>()) < 4.0);
  CHECK(record["arrays"]["parameter_probability"]["data"][1].get<double>() > 1e-4);
  CHECK(record["arrays"]["poles"]["shape"][0] == 2);
  CHECK(holds(ended.out, "apart [std]"));

  const auto same = run_bodeflow({"compare", "first", "first", "--out", "same"}, folder.path());
  CHECK(holds(same.err, "come from the same data"));

  const auto with_data = run_bodeflow(
      {"compare", "first", "second", "--data", "b.csv", "--input", "voltage", "--output", "current", "--out", "data", "--json"},
      folder.path());
  INFO(with_data.err);
  REQUIRE(with_data.exit_code == 0);
  const auto fits =
      nlohmann::json::parse(with_data.out)["results"]["compare"]["arrays"]["fit"]["data"].get<std::vector<double>>();
  REQUIRE(fits.size() == 2);
  CHECK(fits[0] > 70.0);
  CHECK(fits[1] == Approx(fits[0]).margin(2.0));
}

TEST_CASE("compare warns of an amplitude and a band that the model was not fitted to") {
  const Folder folder;
  BenchData strong;
  strong.amplitude = 10.0;
  folder.write("bench.csv", bench_csv(strong));
  std::string narrow = exact_model(3.4);
  narrow.replace(narrow.find("50.0]"), 5, "20.0]");
  folder.write("model.json", narrow);
  const auto ended =
      run_bodeflow({"compare", "model.json", "--data", "bench.csv", "--input", "voltage", "--output", "current", "--out", "out"},
                   folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(holds(ended.err, "of the data it was fitted to: a plant that is not linear answers otherwise"));
  CHECK(holds(ended.err, "outside the band of 0 to 20 Hz in which it was fitted"));
}

TEST_CASE("compare says what is missing or no model") {
  const Folder folder;
  folder.write("bench.csv", bench_csv({300, 1, 0.1, 1.0, 0}));
  folder.write("model.json", exact_model(1.0));
  CHECK(holds(refusal(folder, {"compare", "model.json"}, 2), "one model alone: give another one"));
  CHECK(holds(refusal(folder, {"compare", "model.json", "nowhere"}, 3), "nowhere: no such file, run directory or result.json"));
  CHECK(holds(refusal(folder, {"compare", "model.json", "model.json", "--steps", "3"}, 2), "belong to --data"));
  CHECK(holds(refusal(folder, {"compare", "model.json", "--data", "bench.csv"}, 3),
              "--input is missing: which column is the input?"));
  folder.write("other.json", R"({"bodeflow": 1, "results": {"trace": {"type": "trace"}}})");
  CHECK(holds(refusal(folder, {"compare", "model.json", "other.json"}, 3),
              "other.json: no record of type 'model'; it has trace (trace)"));
  folder.write("broken.json", "{\"bodeflow\": 1,\n \"results\": {\"a\" 3}}");
  CHECK(holds(refusal(folder, {"compare", "model.json", "broken.json"}, 3), "broken.json:2:18: is no JSON"));
  folder.write("response.csv", "f [Hz],re(G),im(G)\n1,2,3\n2,2,3\n3,1,1\n");
  CHECK(holds(refusal(folder, {"compare", "model.json", "--data", "response.csv"}, 3),
              "response.csv holds a frequency response; --data takes samples of input and output over time"));
  CHECK(holds(refusal(folder, {"compare", "model.json", "model.json", "--model", "fit"}, 3),
              "no result 'fit'; it has identify (model)"));
}
