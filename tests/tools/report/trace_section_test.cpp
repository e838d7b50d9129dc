#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "report/report.hpp"
#include "system/command.hpp"
#include "tools/report/run_results.hpp"

using namespace bodeflow;
using namespace bodeflow::tools::report;
using Catch::Matchers::Contains;
using nlohmann::ordered_json;
using test::Folder;

namespace {

ordered_json array_of(const std::string& unit, const std::vector<std::uint64_t>& shape, const std::vector<double>& data) {
  return {{"unit", unit}, {"shape", shape}, {"data", data}};
}

ordered_json trace() {
  ordered_json record = {{"type", "trace"},
                         {"attributes",
                          {{"verdict", "named"},
                           {"finding", "Missing effect: dead time of the inverter, 9.88 V."},
                           {"effects", {"dead_time"}},
                           {"unit", "A"},
                           {"error_before", 0.28},
                           {"error_after", 0.03},
                           {"error_remedied", nullptr},
                           {"noise_floor", 0.0288},
                           {"noise_floor_99.9", 0.0305},
                           {"excess_before", 0.2785},
                           {"excess_after", 0.0084},
                           {"conventions", {"the input is the command"}},
                           {"parameter_names", {"gamma"}},
                           {"parameter_units", {"1/s"}},
                           {"effect_parameter_names", {"dead_time_voltage"}},
                           {"effect_parameter_units", {"V"}},
                           {"class_names", {"excited", "odd"}},
                           {"class_records", {"fit 1", "select"}},
                           {"class_p_limit", 0.0004},
                           {"candidate_names", {"dead_time", "delay"}},
                           {"candidate_reasons", {"added", "not physical: delay would be below 0 s"}}}}};
  record["arrays"] = {{"effect_parameters", array_of("", {1}, {9.88})},
                      {"effect_parameter_std", array_of("", {1}, {0.014})},
                      {"parameters_before", array_of("", {1}, {393.4})},
                      {"parameters_before_std", array_of("", {1}, {0.6})},
                      {"parameters_after", array_of("", {1}, {286.3})},
                      {"parameters_after_std", array_of("", {1}, {0.5})},
                      {"class_before", array_of("1", {2, 2}, {39.7, 7.2, 22.0, 1.01})},
                      {"class_after", array_of("1", {2, 2}, {0.98, 1.08, 1.02, 0.97})},
                      {"class_p_before", array_of("1", {2, 2}, {0, 1e-9, 0, 0.4})},
                      {"class_p_after", array_of("1", {2, 2}, {0.6, 0.02, 0.4, 0.5})},
                      {"candidate_fit_gain", array_of("1", {2}, {389351, 147})},
                      {"candidate_p", array_of("1", {2}, {0, 7e-34})},
                      {"candidate_select_gain", array_of("1", {2}, {144826, 149})},
                      {"candidate_share", array_of("1", {2}, {0.9996, 0.001})},
                      {"frequency", array_of("Hz", {4}, {0, 1, 2, 3})},
                      {"residual_before", array_of("A", {4}, {0.001, 0.02, 0.001, 0.01})},
                      {"residual_after", array_of("A", {4}, {0.001, 0.001, 0.001, 0.001})},
                      {"residual_noise", array_of("A", {4}, {0.001, 0.001, 0.001, 0.001})},
                      {"kind", array_of("", {4}, {0, 1, 3, 2})}};
  return record;
}

/// With what newer traces hold: errors and classes of all records, views of the residual of the test record.
ordered_json whole_trace() {
  ordered_json record = trace();
  ordered_json& a = record["attributes"];
  a["noise_floor_0.01"] = 0.0262;
  a["records"] = {"fit 1", "select", "test"};
  a["record_samples"] = {12288, 12288, 4096};
  a["periods"] = 6;
  a["map_signals"] = {"input", "flow at winding"};
  a["map_units"] = {"V", "A"};
  a["course_axis"] = "period";
  a["course_noise"] = 0.07;
  a["autocorrelation_band"] = 0.05;
  ordered_json& r = record["arrays"];
  r["record_error_before"] = array_of("A", {3}, {0.31, 0.27, 0.28});
  r["record_error_after"] = array_of("A", {3}, {0.0287, 0.0301, 0.03});
  r["record_noise"] = array_of("A", {3}, {0.0286, 0.0287, 0.0288});
  r["class_rms_before"] = array_of("A", {3, 2}, {0.301, 0.051, 0.26, 0.03, 0.27, 0.04});
  r["class_rms_after"] = array_of("A", {3, 2}, {0.021, 0.011, 0.022, 0.012, 0.023, 0.013});
  r["class_rms_noise"] = array_of("A", {3, 2}, {0.0205, 0.0105, 0.0205, 0.0105, 0.0205, 0.0105});
  for (const char* name : {"test_class_before", "test_class_after"}) r[name] = array_of("1", {2}, {33.3, 3.31});
  r["test_class_p_before"] = array_of("1", {2}, {0, 0.3});
  r["test_class_p_after"] = array_of("1", {2}, {0.5, 0.3});
  r["map_at"] = array_of("", {2, 4}, {-2, -1, 1, 2, -0.5, 0, 0.5, 0.7});
  r["map_before"] = array_of("A", {2, 4}, {-0.2, -0.2, 0.2, 0.2, -0.1, 0, 0.1, 0.1});
  r["map_after"] = array_of("A", {2, 4}, {0.01, -0.01, 0.01, 0, 0, 0, 0.01, 0.01});
  for (const char* name : {"map_before_std", "map_after_std"})
    r[name] = array_of("A", {2, 4}, {0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01});
  r["course_at"] = array_of("", {3}, {1, 2, 3});
  r["course_before"] = array_of("A", {3}, {0.29, 0.3, 0.29});
  r["course_after"] = array_of("A", {3}, {0.07, 0.071, 0.069});
  r["autocorrelation_lag"] = array_of("s", {4}, {0.001, 0.002, 0.003, 0.004});
  r["autocorrelation_before"] = array_of("1", {4}, {0.9, 0.7, 0.4, 0.1});
  r["autocorrelation_after"] = array_of("1", {4}, {0.01, -0.02, 0.03, 0.01});
  return record;
}

ordered_json reveal() {
  return {{"type", "reveal"},
          {"attributes",
           {{"right", true},
            {"sentence", "Right: the bench hid dead_time (1.4e-06 s)."},
            {"parameter_names", {"gamma"}},
            {"parameter_units", {"1/s"}}}},
          {"arrays",
           {{"parameters_before", array_of("", {1}, {393.4})},
            {"parameters_after", array_of("", {1}, {286.3})},
            {"parameters_after_std", array_of("", {1}, {0.5})},
            {"parameters_true", array_of("", {1}, {285.9})}}}};
}

std::string page_of(const ordered_json& results, const std::string& graph = "") {
  const Folder folder;
  folder.write("result.json", test::result_with(results).dump());
  if (!graph.empty()) folder.write("graph.yaml", graph);
  REQUIRE(write_report({folder.path(), {}}, Registry::with({})));
  return folder.read("report.html");
}

}  // namespace

TEST_CASE("report: a trace says first what is missing, then shows errors, parameters, classes, candidates and the residual") {
  const std::string page = page_of({{"trace", trace()}});
  for (const char* text : {"<b>Missing effect: dead time of the inverter, 9.88 V.</b>",
                           "The noise alone stays below 0.0305 A with a probability of 99.9 %.",
                           "What is not noise: 0.2785 A before, 0.0084 A after.", "Added: dead_time", "dead_time_voltage [V]",
                           "gamma [1/s]", "−27.2 %", "39.7 *", "7.2 *", "not physical: delay would be below 0 s",
                           "Residual on the test record", "Declared: the input is the command."})
    CHECK_THAT(page, Contains(text));
  CHECK_THAT(page, !Contains("1.01 *"));
}

TEST_CASE("report: a trace tells errors and classes of every record in units and multiples, and draws what the residual shows") {
  const std::string page = page_of({{"trace", whole_trace()}});
  for (const char* text :
       {"Noise alone puts the error on the test record between 0.0262 A and 0.0305 A", "it is 0.03 A, within that band.",
        "Error by record [A]", "After / noise", "0.0301", "in multiples of the noise", "33.3 *", ">3.31<",
        "What is left, by class of lines [A]", ">noise<", "0.0205", "Mean of the residual over the input", "Flow at winding [A]",
        "Residual from period to period", "Autocorrelation of the residual", ">95 %<", "12,288", "Periods that are averaged: 6."})
    CHECK_THAT(page, Contains(text));
  CHECK_THAT(page, !Contains("3.31 *"));
}

TEST_CASE("report: of a trace come words, then tables, then drawings, then candidates, and warnings behind the finding") {
  ordered_json record = whole_trace();
  record["attributes"]["warnings"] = {"the fit did not converge"};
  const std::string page = page_of({{"trace", record}});
  std::size_t last = 0;
  for (const char* text : {"<b>Missing effect: dead time", "Noise alone puts", "<p class=\"note\">the fit did not converge",
                           "Error on data not used for fitting", "Added: dead_time", "Parameters of the model", "Error by record",
                           "in multiples of the noise", "by class of lines [A]", "Error of the model",
                           "Residual on the test record", "Mean of the residual over the input", "Residual from period to period",
                           "Candidates, best first", "<caption>Records</caption>", "<ul class=\"warnings\">"}) {
    INFO(text);
    const auto at = page.find(text, last);
    REQUIRE(at != std::string::npos);
    last = at;
  }
}

TEST_CASE("report: a trace that found nothing says where noise alone puts its error, and draws one curve each") {
  ordered_json record = whole_trace();
  ordered_json& a = record["attributes"];
  a["verdict"] = "none";
  a["finding"] = "Nothing is missing: what the model leaves is noise.";
  a["effects"] = ordered_json::array();
  a["error_before"] = a["error_after"] = 0.0291;
  const std::string page = page_of({{"trace", record}});
  for (const char* text :
       {"Nothing is missing", "it is 0.0291 A, within that band.", "Error / noise", "Mean of the residual over"})
    CHECK_THAT(page, Contains(text));
  for (const char* absent : {">before<", ">after<", "After / noise"}) CHECK_THAT(page, !Contains(absent));
}

TEST_CASE("report: views of a trace that do not fit each other are left out") {
  ordered_json record = whole_trace();
  record["arrays"]["map_before"] = array_of("A", {2, 3}, {1, 2, 3, 4, 5, 6});
  record["arrays"]["course_after"] = array_of("A", {2}, {1, 2});
  record["arrays"]["record_noise"] = array_of("A", {1}, {1});
  const std::string page = page_of({{"trace", record}});
  CHECK_THAT(page, Contains("Autocorrelation of the residual"));
  for (const char* absent : {"Mean of the residual over", "Residual from period to period", "Error by record"})
    CHECK_THAT(page, !Contains(absent));
}

TEST_CASE("report: a trace that added nothing tells parameters and classes once") {
  ordered_json record = trace();
  ordered_json& a = record["attributes"];
  a["verdict"] = "none";
  a["finding"] = "Nothing is missing.";
  a["effects"] = ordered_json::array();
  a["effect_parameter_names"] = ordered_json::array();
  for (const char* own : {"effect_parameters", "effect_parameter_std"}) record["arrays"].erase(own);
  record["arrays"]["parameters_after"] = record["arrays"]["parameters_before"];
  record["arrays"]["class_after"] = record["arrays"]["class_before"];
  const std::string page = page_of({{"trace", record}});
  for (const char* text : {"gamma [1/s]", ">Value<", "393.4", "39.7 *"}) CHECK_THAT(page, Contains(text));
  for (const char* absent : {">Before<", ">After<", ">Change<", ">before<", ">after<"}) CHECK_THAT(page, !Contains(absent));
}

TEST_CASE("report: a trace whose arrays do not fit is shown as far as they do") {
  ordered_json broken = trace();
  broken["arrays"]["class_after"] = array_of("1", {3}, {1, 2, 3});
  broken["arrays"]["candidate_p"] = array_of("1", {1}, {0.5});
  broken["arrays"]["residual_noise"] = array_of("A", {2}, {1, 1});
  const std::string page = page_of({{"trace", broken}});
  CHECK_THAT(page, Contains("Missing effect: dead time"));
  for (const char* absent : {"What is left, by class", "Candidates, best first", "Residual on the test record"})
    CHECK_THAT(page, !Contains(absent));
}

TEST_CASE(
    "report: a trace with several effects says which can't be told apart, what each record was for, and what was not tried") {
  ordered_json record = trace();
  ordered_json& a = record["attributes"];
  a["effects"] = {"dead_time", "delay"};
  a["effect_labels"] = {"dead_time", "delay"};
  a["effect_equivalents"] = {"", "skin_effect"};
  a["candidate_steps"] = {1, 2};
  a["advice"] = {"to tell a delay from a skin effect, measure the delay of the sensor"};
  a["not_tried"] = {"backlash"};
  a["not_tried_reasons"] = {"acts at places of kind coupling, which the base model has not"};
  a["records"] = {"fit 1", "select"};
  a["record_checksums"] = {"0123456789abcdef0123", "fedcba"};
  record["arrays"]["record_levels"] = array_of("V", {2}, {13.2, 24.1});
  const std::string page = page_of({{"trace", record}});
  for (const char* text :
       {"delay can&#39;t be told from skin_effect with these data.", "to tell a delay from a skin effect",
        "Added: dead_time and delay", "with dead_time and delay, test record",
        "Effects of the catalogue that could not be tried: 1", "ranks the candidates", "0123456789abcdef<", "Input, rms [V]"})
    CHECK_THAT(page, Contains(text));
}

TEST_CASE("report: what was measured with the remedy stands beside the errors before") {
  ordered_json record = trace();
  ordered_json& a = record["attributes"];
  a["remedy"] = "Switched on in the drive: dead-time compensation of 1.4e-06 s.";
  a["sentence_remedied"] = "Measured again, the model without the effect has an error of 0.031 A.";
  a["error_remedied"] = 0.031;
  a["excess_remedied"] = 0.0115;
  a["noise_floor_remedied"] = 0.0288;
  record["arrays"]["remedied_at"] = array_of("Hz", {4}, {0, 1, 2, 3});
  record["arrays"]["residual_remedied"] = array_of("A", {4}, {0.001, 0.002, 0.001, 0.001});
  const std::string page = page_of({{"remeasure", record}});
  for (const char* text : {"Switched on in the drive: dead-time compensation", "without it, measured with the remedy", "0.0115",
                           "Residual of the model without the effect"})
    CHECK_THAT(page, Contains(text));
  CHECK_THAT(page, !Contains("Candidates, best first"));
}

TEST_CASE("report: a trace whose noise is not known claims nothing about noise, and draws the residual without it") {
  ordered_json record = trace();
  ordered_json& a = record["attributes"];
  for (const char* of_noise : {"noise_floor", "noise_floor_99.9"}) a[of_noise] = nullptr;
  a["class_names"] = {"whiteness"};
  for (const char* classes : {"class_before", "class_after", "class_p_before", "class_p_after"})
    record["arrays"][classes] = array_of("1", {2, 1}, {1.0, 1e-9});
  record["arrays"].erase("residual_noise");
  const std::string page = page_of({{"trace", record}});
  for (const char* text : {"Its noise is not known.", "a residual that does not look like noise", "Residual on the test record",
                           "Measured minus predicted. Where the noise is not known"})
    CHECK_THAT(page, Contains(text));
  for (const char* absent :
       {"The noise alone stays below", "What is not noise", "in multiples of the noise", "three times the noise"})
    CHECK_THAT(page, !Contains(absent));
}

TEST_CASE("report: a residual over time is drawn with the measured course") {
  ordered_json record = trace();
  record["arrays"].erase("frequency");
  record["arrays"].erase("kind");
  record["arrays"].erase("residual_noise");
  record["arrays"]["time"] = array_of("s", {4}, {0, 1, 2, 3});
  record["arrays"]["measured"] = array_of("A", {4}, {0, 1, 2, 1});
  const std::string page = page_of({{"trace", record}});
  CHECK_THAT(page, Contains("Measured minus predicted. Where the noise is not known"));
  CHECK_THAT(page, Contains("Time [s]"));
}

TEST_CASE("report: the truth stands beside the parameters, and what the graph shows comes first") {
  const ordered_json results = {
      {"hide.secret",
       {{"type", "bench_properties"}, {"attributes", {{"effect", "dead_time"}}}, {"arrays", ordered_json::object()}}},
      {"trace.trace", trace()},
      {"open.reveal", reveal()}};
  const std::string page = page_of(results, "bodeflow: 1\nphases: []\nsummary: {show: [trace.trace, open.reveal]}\n");
  CHECK_THAT(page, Contains("<b>Right: the bench hid dead_time (1.4e-06 s).</b>"));
  CHECK_THAT(page, Contains("Parameters beside the true ones"));
  const auto trace_at = page.find("<section id=\"trace.trace\">"), reveal_at = page.find("<section id=\"open.reveal\">"),
             secret_at = page.find("<section id=\"hide.secret\">");
  REQUIRE(secret_at != std::string::npos);
  CHECK(trace_at < reveal_at);
  CHECK(reveal_at < secret_at);
}
