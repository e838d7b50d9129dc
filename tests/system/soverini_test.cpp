// The graphs of graphs/soverini_catania, short, and as they stand beside the paper's figures.

#include <cmath>
#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Json = nlohmann::json;

namespace {

Json result(const Folder& folder, const std::string& graph, const std::string& runs) {
  const auto ended = run_bodeflow(
      {"run", BODEFLOW_SOURCE_DIR "/graphs/soverini_catania/" + graph, "--set", "runs=" + runs, "--out", "out"}, folder.path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  return Json::parse(folder.read("out/result.json"))["results"];
}

double number(const Json& record, const char* array, std::size_t at) {
  return record["arrays"][array]["data"].at(at).get<double>();
}

/// All six entries of a table beside the paper's: means within four standard deviations of a mean, spreads within ranges.
void compare_with_paper(const Json& table, double lambda_and_beta_0_low, double lambda_and_beta_0_high) {
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string name = table["attributes"]["quantity_names"][i];
    const double mean = number(table, "mean", i), std = number(table, "std", i);
    const double paper_mean = number(table, "published_mean", i), paper_std = number(table, "published_std", i);
    CAPTURE(name, mean, std, paper_mean, paper_std);
    CHECK(std::abs(mean - paper_mean) < 4.0 * std::hypot(std, paper_std) / 10.0);
    const bool exact_in_paper = name == "lambda_u" || name == "beta_0";
    CHECK(std / paper_std > (exact_in_paper ? lambda_and_beta_0_low : 0.7));
    CHECK(std / paper_std < (exact_in_paper ? lambda_and_beta_0_high : 1.4));
  }
}

}  // namespace

TEST_CASE("example 1 is exact without noise and near the truth with it") {
  const Folder folder;
  const Json all = result(folder, "example_1.yaml", "1..4");
  const double truth[] = {-0.5, 0.3, 2.0, -1.2, -0.6};
  for (std::size_t i = 0; i < 5; ++i) CHECK(std::abs(number(all["noise_free.identify"], "parameters", i) - truth[i]) < 1e-10);
  const Json& table = all["tables.independent_1000"];
  CHECK(table["attributes"]["runs"] == 4);
  CHECK(std::abs(number(table, "mean", 3) - 2.0) < 0.12);
}

TEST_CASE("example 2 has the response of the window with the right noise matrix alone") {
  const Folder folder;
  const Json all = result(folder, "example_2.yaml", "1..4");
  const auto error = [&](const char* way) {
    return all[std::string("figure_2.") + way + "_truth.error"]["attributes"]["error_of_mean"].get<double>();
  };
  CHECK(error("window") < 0.1);
  CHECK(error("refined") < 0.1);
  CHECK(error("full_range") > 0.5);
}

TEST_CASE("example 3 has the poles of the masses, best in a window") {
  const Folder folder;
  const Json all = result(folder, "example_3.yaml", "1..4");
  CHECK(number(all["table_3.window"], "mean", 1) == Approx(1.6872).margin(0.005));
  CHECK(number(all["table_3.window"], "mean", 3) == Approx(4.6576).margin(0.05));
  CHECK(number(all["table_3.fd_kl"], "mean", 3) == Approx(4.6576).margin(0.4));
}

TEST_CASE("examples 1 to 3 over 100 runs are those of the paper, where it is right", "[long]") {
  const Folder first, second, third;
  const Json tables = result(first, "example_1.yaml", "1..100");
  for (const char* samples : {"250", "500", "1000"}) {
    compare_with_paper(tables[std::string("tables.decorrelated_") + samples], 0.7, 1.4);
    compare_with_paper(tables[std::string("tables.independent_") + samples], 1.4, 2.6);
  }
  const Json window = result(second, "example_2.yaml", "1..100");
  CHECK(window["figure_2.window_truth.error"]["attributes"]["error_of_mean"] < 0.02);
  CHECK(window["figure_2.identity_truth.error"]["attributes"]["error_of_mean"] > 0.08);
  CHECK(number(window["figure_2.window"], "mean", 0) == Approx(0.0968).margin(0.003));
  const Json masses = result(third, "example_3.yaml", "1..100");
  const Json &kl = masses["over_forces.fd_kl"], &tls = masses["over_forces.tls"];
  CHECK(number(tls, "std", 3) > 5.0 * number(kl, "std", 3));
  for (std::size_t i = 0; i < 4; ++i)
    CHECK(std::abs(number(kl, "published_mean", i) - number(kl, "mean", i)) < number(kl, "std", i));
}
