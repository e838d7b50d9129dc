#include <algorithm>
#include <fstream>

#include "catch.hpp"
#include "report/report.hpp"
#include "system/command.hpp"
#include "tools/report/run_results.hpp"

using namespace bodeflow;
using namespace bodeflow::tools::report;
using Catch::Matchers::Contains;
using test::Folder;

namespace {

Registry no_plugins() { return Registry::with({}); }

WrittenReport written(const Folder& folder) {
  const auto report = write_report({folder.path(), {}}, no_plugins());
  REQUIRE(report);
  return *report;
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

}  // namespace

TEST_CASE("report: every record type has its section, figures and files") {
  const Folder folder;
  folder.write("result.json", test::result_with(test::results_of_all_types()).dump());
  const WrittenReport report = written(folder);
  CHECK(report.records == 18);
  const std::string page = folder.read("report.html");
  for (const char* text : {"id=\"response\"",
                           "id=\"matrix\"",
                           "Levels at angle",
                           "auto-spectra",
                           "Poles and zeros",
                           "Published mean",
                           "Truth in the 95 % interval",
                           "94 %",
                           "Not accepted: phase margin 21 degrees",
                           "The missing effect is named",
                           "Delay 8×10⁻⁴ s",
                           "Measured and simulated output",
                           "Parameters side by side",
                           "below 0.01 %",
                           "Order 2 is taken: the lowest that no higher one undercuts",
                           "By bands",
                           "Nothing speaks against a white residual",
                           "Cost 120, expected 76 ± 8.72: 5.05 standard deviations too much",
                           "Convention: continuous in time.",
                           "0.9804 to 1.0196",
                           "0.1 to 5 Hz",
                           "without scatter all of them pass through the true variances",
                           "something_new",
                           "Impulse response",
                           "-3 dB from [Hz]",
                           "in 3 runs",
                           "only 6 periods: measure 12"}) {
    INFO(text);
    CHECK(page.find(text) != std::string::npos);
  }
  CHECK(report.plots.size() > 20);
  for (const auto& plot : report.plots) CHECK(std::filesystem::file_size(plot) > 500);
  CHECK(page.find("NaN") == std::string::npos);
  CHECK(page.size() < 2'000'000);
}

TEST_CASE("report: warnings of all records stand first, the same text once") {
  const Folder folder;
  folder.write("result.json", test::result_with(test::results_of_all_types()).dump());
  const auto report = written(folder);
  CHECK(std::count(report.warnings.begin(), report.warnings.end(), "response, matrix: only 6 periods: measure 12") == 1);
  const std::string page = folder.read("report.html");
  CHECK(page.find("id=\"Warnings\"") < page.find("id=\"response\""));
}

TEST_CASE("report: the page loads nothing, runs nothing, and says so to the browser") {
  const Folder folder;
  folder.write("result.json", test::result_with(test::results_of_all_types()).dump());
  written(folder);
  const std::string page = folder.read("report.html");
  CHECK_THAT(page, Contains("default-src &#39;none&#39;"));
  CHECK(count(page, "http://") == count(page, "http://www.w3.org/2000/svg"));
  for (const char* word : {"<script", "<link", "<iframe", "@import", "url(", "https://", "<img"})
    CHECK(page.find(word) == std::string::npos);
}

TEST_CASE("report: names and texts from files never become markup") {
  const Folder folder;
  auto record = test::response_record(1, 1);
  const std::string hostile = test::kHostile;
  record["attributes"]["output_names"] = {hostile};
  record["attributes"]["response_units"] = {hostile};
  record["attributes"]["warnings"] = {hostile};
  record["attributes"][hostile] = hostile;
  record["arrays"]["response"]["unit"] = hostile;
  nlohmann::ordered_json results;
  results[hostile] = record;
  const auto all = test::results_of_all_types();
  for (const auto& [key, other] : all.items()) {
    auto& renamed = results[key + hostile] = other;
    if (other["type"] == "something_new") renamed["type"] = hostile;
    nlohmann::ordered_json arrays;
    for (const auto& [name, array] : other["arrays"].items()) arrays[name] = array;
    arrays[hostile] = {{"unit", hostile}, {"shape", {30}}, {"data", std::vector<double>(30, 1.0)}};
    renamed["arrays"] = arrays;
  }
  folder.write("result.json", test::result_with(results).dump());
  folder.write("manifest.json", nlohmann::json{{"title", hostile},
                                               {"graph", hostile},
                                               {"status", hostile},
                                               {"reason", hostile},
                                               {"host", {{"name", hostile}}},
                                               {"plugins", {{{"name", hostile}, {"sha256", hostile}}}},
                                               {"inputs", {{{"path", hostile}, {"blocks", {hostile}}}}}}
                                    .dump());
  folder.write("graph.yaml", "bodeflow: 1\nblocks:\n  \"" + std::string("</table><script>alert(3)</script>") +
                                 "\": {block: \"<b>\", x: \"<i>\"}\n");
  folder.write("events.jsonl", nlohmann::json{{"time", hostile}, {"event", hostile}, {hostile, hostile}}.dump() + "\n");
  folder.write("log.txt", "2026-11-22T04:31:15.303Z warning x: " + hostile + "\n");
  const WrittenReport report = written(folder);
  const std::string page = folder.read("report.html");
  CHECK(page.find("<script") == std::string::npos);
  CHECK(page.find("<img") == std::string::npos);
  CHECK(count(page, "</style>") == 1);
  CHECK(count(page, "</title>") == 1 + count(page, "<svg"));
  for (const auto& plot : report.plots) {
    CHECK(plot.parent_path() == folder.path() / "plots");
    CHECK(folder.read("plots/" + plot.filename().string()).find("<script") == std::string::npos);
  }
}

TEST_CASE("report: paced phases show on each host how late their chunks began and what was not permitted") {
  const nlohmann::json paced = {{"clock", "realtime"},
                                {"on_overrun", "skip"},
                                {"priority", 80},
                                {"cores", {1}},
                                {"not_permitted", {"priority 80 is not permitted"}},
                                {"overruns", 7},
                                {"skipped", 3},
                                {"chunks", 60010},
                                {"min_s", 2e-6},
                                {"median_s", 13.5e-6},
                                {"p99_s", 41e-6},
                                {"max_s", 2.5e-3},
                                {"bins", {0, 0, 10, 20000, 30000, 9990, 0, 0, 0, 0, 0, 10}}};
  const auto manifest = [](const nlohmann::json& pacing) {
    const nlohmann::json on_bench = {{"clock", "hardware"}, {"overruns", 2}, {"chunks", 0}};
    return nlohmann::json{{"status", "complete"},
                          {"phases", {{{"phase", "hold"}, {"repeat", 0}, {"pacing", pacing}}}},
                          {"hosts", {{{"host", "bench"}, {"phase", "hold"}, {"repeat", 0}, {"pacing", on_bench}}}}}
        .dump();
  };
  const Folder folder;
  folder.write("result.json", test::result_with({{"r", test::response_record(1, 1)}}).dump());
  folder.write("manifest.json", manifest(paced));
  const WrittenReport report = written(folder);
  const std::string page = folder.read("report.html");
  for (const char* text :
       {"id=\"Pacing\"", "60,010", "13.5", "2500", "realtime, on_overrun: skip, priority 80 (not permitted), cores [1]",
        "hardware, without priority", "bench", "priority 80 is not permitted"}) {
    INFO(text);
    CHECK(page.find(text) != std::string::npos);
  }
  const auto is_histogram = [](const auto& plot) { return plot.filename() == "lateness_hold.svg"; };
  CHECK(std::count_if(report.plots.begin(), report.plots.end(), is_histogram) == 1);

  folder.write("manifest.json", manifest({{"bins", {"x", -1, nullptr, 1e300}}, {"chunks", -3}, {"cores", "all"}}));
  written(folder);
}

TEST_CASE("report: limits stand in a table with what came and how often they were left") {
  const nlohmann::json speed = {{"signal", "drive.feedback"},
                                {"channels", {"speed"}},
                                {"unit", "rpm"},
                                {"min", nullptr},
                                {"max", 450.0},
                                {"rate_per_s", 2000.0},
                                {"on_violation", "stop"},
                                {"samples", 98},
                                {"violations", 1},
                                {"lowest", -6.3},
                                {"highest", 456.0},
                                {"steepest_per_s", 555.0},
                                {"first", {{"bound", "max"}, {"value", 456.0}, {"time_s", 1.94}}},
                                {"ended_run", true}};
  nlohmann::json broken = speed;
  broken["first"]["value"] = "nan";
  broken["ended_run"] = 3;
  const auto manifest = [](const nlohmann::json& limits) {
    return nlohmann::json{
        {"status", "limit"}, {"reason", "limit violated"}, {"phases", {{{"phase", "loop"}, {"limits", limits}}}}}
        .dump();
  };
  const Folder folder;
  folder.write("result.json", test::result_with({{"r", test::response_record(1, 1)}}).dump());
  folder.write("manifest.json", manifest({speed, broken, 5}));
  written(folder);
  const std::string page = folder.read("report.html");
  for (const char* text :
       {"id=\"Limits\"", "loop.drive.feedback speed", "at most 450 rpm, changes of at most 2000 rpm/s", "ended the run",
        "1 of 98, the first at 1.94 s: 456 rpm", "the first at 1.94 s: nan", "ended by a limit"}) {
    INFO(text);
    CHECK(page.find(text) != std::string::npos);
  }
}

TEST_CASE("report: samples that are missing because a host was lost stand there to the sample") {
  const nlohmann::json gap = {{"phase", ""},   {"host", ""},    {"connection", "twice.out -> back.in"},
                              {"first", 2300}, {"count", 1112}, {"from_s", 2.3},
                              {"to_s", 3.412}, {"epoch", 1}};
  const nlohmann::json restart = {{"phase", ""}, {"host", "bench"}, {"epoch", 1}, {"begin_s", 3.412}};
  const Folder folder;
  folder.write("result.json", test::result_with({{"r", test::response_record(1, 1)}}).dump());
  const auto page = [&](const nlohmann::json& gaps, const nlohmann::json& restarts) {
    folder.write("manifest.json", nlohmann::json{{"status", "complete"}, {"gaps", gaps}, {"restarts", restarts}}.dump());
    written(folder);
    return folder.read("report.html");
  };
  const std::string told = page(nlohmann::json::array({gap}), nlohmann::json::array({restart}));
  for (const char* text : {"Missing samples", "twice.out -&gt; back.in", "launcher", "2,300", "3,411", "1,112", "3.412",
                           "Host bench was lost", "restarted/bench"}) {
    INFO(text);
    CHECK(told.find(text) != std::string::npos);
  }
  CHECK(page(nlohmann::json::array(), nlohmann::json::array({restart}))
            .find("No connection that another host reads misses a sample.") != std::string::npos);
  CHECK(page(nlohmann::json::array({nullptr, {{"first", -1}, {"count", "x"}}}), nlohmann::json::array({3, {{"host", 5}}}))
            .find("Missing samples") != std::string::npos);
  CHECK(page(nullptr, nullptr).find("Missing samples") == std::string::npos);
}

TEST_CASE("report: a folder that holds no run is refused by name") {
  const Folder folder;
  const auto report = write_report({folder.path(), {}}, no_plugins());
  REQUIRE_FALSE(report);
  CHECK(report.error() ==
        "'" + folder.path().string() + "' is no run directory: it has no result.json, manifest.json or data.h5");
  CHECK(write_report({folder.path() / "absent", {}}, no_plugins()).error() ==
        "'" + (folder.path() / "absent").string() + "' is no folder");
}

TEST_CASE("report: a damaged run shows what can be read and names the rest") {
  const Folder folder;
  folder.write("manifest.json", R"({"status": "running", "title": "Half a run"})");
  folder.write("data.h5", "no HDF5 at all");
  folder.write("graph.yaml", "just a text");
  const WrittenReport report = written(folder);
  CHECK(report.status == "not finished");
  CHECK(report.problems.size() == 3);
  const std::string page = folder.read("report.html");
  CHECK_THAT(page, Contains("Half a run"));
  CHECK_THAT(page, Contains("result.json is missing"));
}

TEST_CASE("report: results cut off anywhere and bytes changed anywhere still give a page") {
  const std::string whole = test::result_with(test::results_of_all_types()).dump();
  std::uint64_t state = 12345;
  const auto random = [&](std::size_t below) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>(state >> 33U) % below;
  };
  const Folder folder;
  for (int round = 0; round < 12; ++round) {
    std::string text = whole;
    if (round % 2 == 0) text.resize(random(whole.size()));
    for (int n = 0; n < 20 && !text.empty(); ++n) text[random(text.size())] = "0123456789[]{}\",:.-e"[random(20)];
    folder.write("result.json", text);
    CHECK(write_report({folder.path(), {}}, no_plugins()));
  }
}

TEST_CASE("report: numbers of any size, missing and infinite ones give finite drawings") {
  auto results = test::results_of_all_types();
  const double values[] = {1e308, -1e308, 5e-324, 0.0, -0.0, 1e-200, 3.0};
  std::size_t next = 0;
  for (auto& [key, record] : results.items())
    for (auto& [name, array] : record["arrays"].items())
      for (auto& value : array["data"]) {
        const std::size_t choice = next++ % 9;
        const nlohmann::ordered_json number =
            choice < 7 ? nlohmann::ordered_json(values[choice]) : nlohmann::ordered_json(nullptr);
        if (value.is_array())
          value = {number, number};
        else
          value = number;
      }
  const Folder folder;
  folder.write("result.json", test::result_with(results).dump());
  const WrittenReport report = written(folder);
  for (const auto& plot : report.plots) {
    const std::string svg = folder.read("plots/" + plot.filename().string());
    for (const char* word : {"nan", "inf", "NaN"}) CHECK(svg.find(std::string("\"") + word) == std::string::npos);
    CHECK(count(svg, " nan") + count(svg, "-nan") + count(svg, " inf") + count(svg, "-inf") == 0);
  }
}

TEST_CASE("report: with --out the drawings stand beside the page under its name") {
  const Folder folder;
  folder.write("run/result.json", test::result_with({{"r", test::response_record(1, 1)}}).dump());
  const auto report = write_report({folder.path() / "run", folder.path() / "shown.html"}, no_plugins());
  REQUIRE(report);
  CHECK(report->plots[0].parent_path() == folder.path() / "shown_plots");
  CHECK_FALSE(std::filesystem::exists(folder.path() / "run" / "plots"));
}

TEST_CASE("report: ten million lines are rendered in bounded size", "[long]") {
  const Folder folder;
  constexpr std::size_t kLines = 10'000'000;
  std::ofstream file(folder.path() / "result.json");
  const auto list = [&](const char* name, const char* shape, auto value) {
    file << '"' << name << R"(":{"unit":"","shape":)" << shape << R"(,"data":[)";
    for (std::size_t k = 0; k < kLines; ++k) file << (k == 0 ? "" : ",") << value(k);
    file << "]}";
  };
  file
      << R"({"bodeflow":1,"graph":"g","status":"complete","results":{"r":{"type":"frequency_response","attributes":{"periods":6},"arrays":{)";
  list("frequency", "[10000000]", [](std::size_t k) { return std::to_string(k + 1); });
  file << ',';
  list("response", "[10000000,1,1]", [](std::size_t k) { return "[" + std::to_string(1 + k % 7) + ",0.5]"; });
  file << ',';
  list("variance", "[10000000,1,1]", [](std::size_t) { return "0.01"; });
  file << "}}}}";
  file.close();
  written(folder);
  CHECK(std::filesystem::file_size(folder.path() / "report.html") < 1'000'000);
}
