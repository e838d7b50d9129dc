#include "score/score.hpp"

#include <cmath>

#include "catch.hpp"
#include "common/sha256.hpp"
#include "generate/random.hpp"
#include "score/report.hpp"
#include "score/statistics.hpp"
#include "system/command.hpp"

using namespace battery;
using bodeflow::test::Folder;
using bodeflow::test::run_program;

namespace {

Truth hidden(const std::string& kind, const std::string& effect, double size = 1.0) {
  return {"0001", "motor", kind, effect, size, {}};
}

Answer answer(const std::string& verdict, const std::vector<std::string>& effects = {},
              const std::vector<std::string>& equivalents = {}) {
  Answer a;
  a.failed = false;
  a.verdict = verdict;
  a.effects = effects;
  a.equivalents = equivalents;
  a.error_before = 2.0;
  a.error_after = a.floor = 1.0;
  return a;
}

Outcome judged(const Truth& t, const Answer& a) { return judge(t, a, {}, ""); }

const char* const kNamed = R"({"bodeflow": 1, "results": {"trace": {"type": "trace", "attributes": {
  "verdict": "not_separable", "effects": ["residual.delay"], "equivalents": ["skin_effect at rotor"], "effect_parameter_names": ["d"],
  "effect_parameter_units": ["s"], "error_before": 0.2, "error_after": 0.1, "noise_floor": 0.099, "noise_floor_99.9": 0.102, "leak": false,
  "class_names": ["excited", "odd"], "class_records": ["E1"], "candidate_names": ["delay", "hum"]},
  "arrays": {"effect_parameters": {"unit": "", "shape": [1], "data": [1.0e-3]}, "effect_parameter_std": {"data": [2e-5]},
  "class_p_before": {"data": [0.5, null]}, "candidate_p": {"data": [1e-9, 0.3]}}}}})";

/// A folder with a battery of two cases and committed answers.
struct Files {
  Folder folder;
  Files() {
    const std::string truth = R"({"battery": 1, "cases": [
      {"case": "0001", "plant": "motor", "class": "single", "effect": "delay", "size": 0.5, "values": [{"name": "delay", "unit": "s", "value": 0.99e-3}]},
      {"case": "0002", "plant": "motor", "class": "clean", "effect": "none", "size": 0, "values": []}]})";
    const std::string none = R"({"attributes": {"verdict": "none", "effects": []}, "arrays": {}})";
    folder.write("sealed/truth.json", truth);
    folder.write("sealed/salt", "salt");
    folder.write("manifest.json", R"({"truth_sha256": ")" + sha256_hex("salt" + truth) + "\"}");
    folder.write("answers/0001.json", kNamed);
    folder.write("answers/0002.json", none);
    folder.write("answers/manifest.json",
                 R"({"answers_sha256": {"0001": ")" + sha256_hex(kNamed) + R"(", "0002": ")" + sha256_hex(none) + "\"}}");
  }
  bodeflow::test::Ended score(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {BATTERY_SCORE, "--battery", ".", "--answers", "answers"});
    return run_program(options, folder.path());
  }
};

}  // namespace

TEST_CASE("battery: answers are judged as they should be") {
  CHECK(judged(hidden("clean", "none"), answer("none")) == Outcome::right);
  CHECK(judged(hidden("clean", "none"), answer("unexplained")) == Outcome::wrong);
  CHECK(judged(hidden("clean", "none"), answer("named", {"hum"})) == Outcome::wrong);
  const Truth delay = hidden("single", "delay");
  CHECK(judged(delay, answer("named", {"delay"})) == Outcome::right);
  CHECK(judged(delay, answer("not_separable", {"delay"}, {"sensor_lag"})) == Outcome::right);
  CHECK(judged(delay, answer("not_separable", {"sensor_lag"}, {"delay"})) == Outcome::equivalent);
  CHECK(judged(delay, answer("named", {"sensor_lag"})) == Outcome::wrong);
  CHECK(judged(delay, answer("named", {"delay", "hum"})) == Outcome::wrong);
  CHECK(judged(delay, answer("none")) == Outcome::silent);
  CHECK(judged(delay, answer("unexplained")) == Outcome::unexplained);
  const Truth wobble = hidden("outside", "gain_wobble");
  CHECK(judged(wobble, answer("unexplained")) == Outcome::right);
  CHECK(judged(wobble, answer("none")) == Outcome::silent);
  CHECK(judged(wobble, answer("named", {"gain_wobble"})) == Outcome::wrong);
  CHECK(judged(delay, Answer{}) == Outcome::failed);
}

TEST_CASE("battery: an effect that was left out of the catalogue is a stranger, its twin no error") {
  const Truth delay = hidden("single", "delay");
  CHECK(judge(delay, answer("unexplained"), {}, "delay") == Outcome::right);
  CHECK(judge(delay, answer("named", {"sensor_lag"}), {}, "delay") == Outcome::wrong);
  CHECK(judge(delay, answer("named", {"sensor_lag"}), {{"delay", "sensor_lag"}}, "delay") == Outcome::equivalent);
  CHECK(judge(delay, answer("named", {"sensor_lag"}), {{"sensor_lag", "delay"}}, "delay") == Outcome::equivalent);
}

TEST_CASE("battery: a result file is read, places and families cut from the names") {
  const Answer a = read_answer(Json::parse(kNamed));
  CHECK(!a.failed);
  CHECK(a.effects == std::vector<std::string>{"delay"});
  CHECK(a.equivalents == std::vector<std::string>{"skin_effect"});
  CHECK(a.parameters == std::vector<double>{1e-3});
  CHECK(a.at_floor);
  CHECK(a.class_p.size() == 2);
  CHECK(std::isnan(a.class_p[1]));
  const Answer failed = read_answer(Json::parse(R"({"failed": 3, "message": "no such file"})"));
  CHECK(failed.failed);
  CHECK(failed.message == "no such file");
}

TEST_CASE("battery: a parameter is compared where its unit and, among several, its name agree") {
  Judged j{hidden("single", "stop"), answer("named", {"stop"}), Outcome::right};
  j.truth.values = {{"gap", "m", 1.0}, {"stiffness", "N/m", 5.0}};
  j.answer.parameter_names = {"k", "gap", "width"};
  j.answer.parameter_units = {"N / m", "m", "m"};
  j.answer.parameters = {5.1, 1.3, 0.2};
  j.answer.parameter_std = {0.1, 0.1, 0.1};
  const auto checked = check_values(j);
  REQUIRE(checked.size() == 2);
  CHECK(checked[0].value == 1.3);
  CHECK(!checked[0].inside());
  CHECK(checked[1].value == 5.1);
  CHECK(checked[1].inside());
  j.outcome = Outcome::equivalent;
  CHECK(check_values(j).empty());
}

TEST_CASE("battery: the counts are those of the cases") {
  std::vector<Judged> cases;
  const auto add = [&](const Truth& t, const Answer& a) { cases.push_back({t, a, judged(t, a)}); };
  add(hidden("clean", "none", 0.0), answer("none"));
  add(hidden("clean", "none", 0.0), answer("unexplained"));
  add(hidden("single", "hum", 0.02), answer("none"));
  add(hidden("single", "hum", 0.025), answer("named", {"offset"}));
  add(hidden("single", "hum", 2.0), answer("named", {"hum"}));
  add(hidden("outside", "gain_wobble"), answer("unexplained"));
  add(hidden("outside", "gain_wobble"), answer("named", {"hum"}));
  cases.back().answer.leak = true;
  add(hidden("outside", "gain_wobble"), answer("none"));
  add(hidden("single", "hum"), Answer{});
  const Score s = count(cases, 0.03, 0.1);
  CHECK(s.clean == 2);
  CHECK(s.single == 4);
  CHECK(s.outside == 3);
  CHECK(s.false_alarms == 1);
  CHECK(s.wrong_names == 1);
  CHECK(s.outside_not_unexplained == 2);
  CHECK(s.failed == 1);
  CHECK(s.leaks == 1);
  CHECK(s.below_limit == 2);
  CHECK(s.below_limit_wrong == 1);
  CHECK(s.visible == 2);
  CHECK(s.visible_named == 1);
  const auto checks = checks_of(s, {.false_alarms = 0, .wrong_names = 1, .silent_share = 0.98}, 0.03, 0.1);
  CHECK(!checks[0].passed);
  CHECK(checks[1].passed);
  CHECK(!checks[3].passed);
  CHECK(checks[4].passed);
  const std::string text = report(cases, s, checks);
  CHECK(text.find("| hidden | cases | none | unexplained | hum | offset | failed |") != std::string::npos);
  CHECK(text.find("| hum | 4 | 1 |  | **1** | 1 | 1 |") != std::string::npos);
  CHECK(text.find("| outside: gain_wobble | 3 | 1 | 1 | 1 |  |  |") != std::string::npos);
}

TEST_CASE("battery: uniform p-values pass the test of Kolmogorov and Smirnov, others do not") {
  Random random("uniform");
  std::vector<double> p, squares;
  for (int n = 0; n < 400; ++n) {
    p.push_back(random.uniform());
    squares.push_back(p.back() * p.back());
  }
  CHECK(uniform_probability(p) > 0.01);
  CHECK(uniform_probability(squares) < 1e-6);
  // Stephens (1970): the 5 % point of (sqrt n + 0.12 + 0.11 / sqrt n) D is 1.358; a step of height D at one end.
  CHECK(uniform_probability({0.1, 0.5, 0.9}) > 0.9);
  CHECK(uniform_probability(std::vector<double>(100, 0.5)) < 1e-9);
  int below = 0;
  for (int run = 0; run < 1000; ++run) {
    std::vector<double> values(50);
    for (double& v : values) v = random.uniform();
    below += uniform_probability(values) < 0.1;
  }
  CHECK(below == Approx(100).margin(30));
}

TEST_CASE("battery: the upper limit of a rate is that of Clopper and Pearson") {
  CHECK(upper_rate(0, 37) == Approx(1.0 - std::pow(0.05, 1.0 / 37)).epsilon(1e-6));
  CHECK(upper_rate(5, 100) == Approx(0.1023).epsilon(2e-3));
  CHECK(upper_rate(3, 3) == 1.0);
}

TEST_CASE("battery: the scorer's exit code says whether the limits are kept") {
  const Files files;
  const auto ended = files.score();
  INFO(ended.err);
  CHECK(ended.exit_code == 0);
  CHECK(ended.out.find("# Blind battery: 1 clean, 1 single-effect, 0 outside cases") == 0);
  CHECK(ended.out.find("| delay: delay | 1 | 1 | 1.01 % | 0.5 |") != std::string::npos);
  CHECK(files.score({"--false-alarms", "0", "--wrong-names", "0", "--leaks", "0", "--failed", "0", "--coverage", "0.9:1"})
            .exit_code == 0);
  const auto missed = files.score({"--coverage", "0.5:0.9"});
  CHECK(missed.exit_code == 1);
  CHECK(missed.err == "battery_score: true parameter in the 95 % interval: 1 of 1 = 1, asked 0.5 to 0.9\n");
  CHECK(files.score({"--uniformity", "0.001"}).exit_code == 1);  // no clean case gave p-values
  CHECK(files.score({"--sloppiness", "1"}).exit_code == 2);
}

TEST_CASE("battery: the scorer refuses a truth or an answer that was changed after its digest was given") {
  const Files truth, late, missing;
  truth.folder.write("sealed/salt", "pepper");
  CHECK(truth.score().exit_code == 3);
  CHECK(truth.score().err == "battery_score: the truth is not the one whose digest the manifest has\n");
  late.folder.write("answers/0002.json", "{}");
  CHECK(late.score().err == "battery_score: the answer to case 0002 is not the one that was committed\n");
  missing.folder.write("answers/manifest.json", R"({"answers_sha256": {}})");
  CHECK(missing.score({"--failed", "0"}).exit_code == 1);
}

TEST_CASE("battery: what is no JSON is refused with its place") {
  for (const char* text : {"", "{", "[1,]", "{\"a\" 1}", "nul", "1 2", "\"\\x\"", "[--1]"}) {
    INFO(text);
    CHECK_THROWS_WITH(Json::parse(text), Catch::Contains("no JSON at byte"));
  }
  CHECK(Json::parse(" {\"a\": [1, -2.5e3, null, true, \"\\u00e9\\n\"]} ")["a"].list()[1].number() == -2500.0);
  CHECK(Json::parse("[\"\\u00e9\"]").list()[0].text() == "\xc3\xa9");
}
