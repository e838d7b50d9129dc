#include "tools/report/browser.hpp"

#include "catch.hpp"
#include "system/command.hpp"
#include "tools/report/run_results.hpp"

using namespace bodeflow::test;

namespace {

/// False, with the reason said: there is no browser.
bool has_browser() {
  if (!browser().empty()) return true;
  WARN("skipped: no Chromium was found");
  return false;
}

/// The report of a whole run of the README's main job, by the command that people type.
std::filesystem::path report_of_run(const Folder& folder) {
  const auto ran = run_bodeflow(
      {"run", BODEFLOW_SOURCE_DIR "/graphs/first_steps/frequency_response.yaml", "--out", (folder.path() / "run").string()});
  REQUIRE(ran.exit_code == 0);
  return folder.path() / "run" / "report.html";
}

std::filesystem::path report_of_all_types(const Folder& folder) {
  folder.write("all/result.json", result_with(results_of_all_types()).dump());
  REQUIRE(run_bodeflow({"report", (folder.path() / "all").string()}).exit_code == 0);
  return folder.path() / "all" / "report.html";
}

void check_layout(const nlohmann::json& found) {
  INFO(found.dump(1));
  REQUIRE_FALSE(found.contains("error"));
  CHECK(found["page_width"] <= found["window_width"]);
  CHECK(found["bad_numbers"].empty());
  CHECK(found["outside"].empty());
  CHECK(found["overlapping"].empty());
  CHECK(found["active"] == 0);
  CHECK(found["texts"] > 50);
}

}  // namespace

TEST_CASE("report in a browser: a run's page fits a telephone and a desk, in light and in dark") {
  if (!has_browser()) return;
  const Folder folder;
  const auto page = report_of_run(folder);
  const auto narrow = measured(page, 390, false), wide = measured(page, 1400, true);
  check_layout(narrow);
  CHECK(narrow["window_width"] == 390);
  check_layout(wide);
  CHECK(narrow["ground"] == "rgb(255, 255, 255)");
  CHECK(wide["ground"] == "rgb(21, 24, 28)");
  CHECK(wide["ink"] == "rgb(232, 234, 237)");
}

TEST_CASE("report in a browser: every record type fits a telephone and a desk") {
  if (!has_browser()) return;
  const Folder folder;
  const auto page = report_of_all_types(folder);
  check_layout(measured(page, 360, false));
  check_layout(measured(page, 1400, false));
}

TEST_CASE("report in a browser: the console stays empty and the page prints") {
  if (!has_browser()) return;
  const Folder folder;
  const auto page = report_of_all_types(folder);
  const auto lines = console_lines(page);
  INFO((lines.empty() ? "" : lines.front()));
  CHECK(lines.empty());
  const std::string pdf = printed(page);
  CHECK(pdf.substr(0, 5) == "%PDF-");
  CHECK(pdf.size() > 50'000);
}

TEST_CASE("report in a browser: the measure sees what it looks for") {
  if (!has_browser()) return;
  const Folder folder;
  const auto page =
      folder.write("bad.html",
                   "<!DOCTYPE html><html><head></head><body><main><div style='width:900px'>wide</div>"
                   "<svg viewBox='0 0 100 100' width='100' height='100'><title>t</title><circle cx='NaN' cy='1' r='2'/>"
                   "<text x='10' y='50'>one</text><text x='12' y='52'>two</text><text x='95' y='90'>outside</text></svg>"
                   "<img alt='x'></main></body></html>");
  const auto found = measured(page, 390, false);
  INFO(found.dump(1));
  CHECK(found["page_width"] > found["window_width"]);
  CHECK(found["bad_numbers"].size() == 1);
  CHECK(found["outside"] == nlohmann::json{"t: outside"});
  CHECK(found["overlapping"] == nlohmann::json{"t: one | two"});
  CHECK(found["active"] == 1);
}

TEST_CASE("report in a browser: hostile names run nothing") {
  if (!has_browser()) return;
  const Folder folder;
  auto record = response_record(1, 1);
  record["attributes"]["output_names"] = {kHostile};
  record["attributes"]["warnings"] = {kHostile};
  folder.write("run/result.json", result_with({{kHostile, record}}).dump());
  REQUIRE(run_bodeflow({"report", (folder.path() / "run").string()}).exit_code == 0);
  check_layout(measured(folder.path() / "run" / "report.html", 390, false));
}
