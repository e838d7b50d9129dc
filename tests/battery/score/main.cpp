#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>

#include "common/sha256.hpp"
#include "score/report.hpp"

/// Compares answers with the truth, after it has seen that both are what was committed. Exit code 0: all limits kept, 1: one
/// missed, 2: usage, 3: files that are not what was committed, or can't be read.

namespace {

using namespace battery;

const char* const kUsage =
    "battery_score --battery DIR --answers DIR [--out FILE.md] [--without EFFECT] [--twins A~B,...]\n"
    "  [--false-alarms N] [--wrong-names N] [--outside N] [--leaks N] [--failed N] [--coverage LOW:HIGH] [--uniformity P]\n"
    "  [--limit SIZE] [--silent-share X] [--visible SIZE] [--named-share X]\n";

struct Options {
  std::filesystem::path battery, answers, out;
  std::string without;
  Twins twins;
  Limits limits;
  double limit = 0.03, visible = 0.1;
};

double real(const std::string& name, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= 0.0))
    throw std::invalid_argument(name + " must be a number, not '" + text + "'");
  return value;
}

int whole(const std::string& name, const std::string& text) {
  const double value = real(name, text);
  if (value > 1e9 || value != static_cast<int>(value))
    throw std::invalid_argument(name + " must be a whole number, not '" + text + "'");
  return static_cast<int>(value);
}

std::pair<std::string, std::string> halves(const std::string& name, const std::string& text, char between) {
  const auto at = text.find(between);
  if (at == std::string::npos) throw std::invalid_argument(name + " must have a '" + between + "', not '" + text + "'");
  return {text.substr(0, at), text.substr(at + 1)};
}

void take(Options& o, const std::string& name, const std::string& value) {
  Limits& l = o.limits;
  if (name == "--battery")
    o.battery = value;
  else if (name == "--answers")
    o.answers = value;
  else if (name == "--out")
    o.out = value;
  else if (name == "--without")
    o.without = value;
  else if (name == "--false-alarms")
    l.false_alarms = whole(name, value);
  else if (name == "--wrong-names")
    l.wrong_names = whole(name, value);
  else if (name == "--outside")
    l.outside = whole(name, value);
  else if (name == "--leaks")
    l.leaks = whole(name, value);
  else if (name == "--failed")
    l.failed = whole(name, value);
  else if (name == "--uniformity")
    l.uniformity = real(name, value);
  else if (name == "--silent-share")
    l.silent_share = real(name, value);
  else if (name == "--named-share")
    l.named_share = real(name, value);
  else if (name == "--limit")
    o.limit = real(name, value);
  else if (name == "--visible")
    o.visible = real(name, value);
  else if (name == "--coverage") {
    const auto [low, high] = halves(name, value, ':');
    l.coverage_low = real(name, low);
    l.coverage_high = real(name, high);
  } else if (name == "--twins") {
    std::istringstream list(value);
    for (std::string pair; std::getline(list, pair, ',');) o.twins.push_back(halves(name, pair, '~'));
  } else {
    throw std::invalid_argument("unknown option '" + name + "'");
  }
}

Options read_options(int argc, char** argv) {
  Options o;
  for (int n = 1; n < argc; n += 2) {
    if (n + 1 == argc) throw std::invalid_argument(std::string("'") + argv[n] + "' needs a value");
    take(o, argv[n], argv[n + 1]);
  }
  if (o.battery.empty() || o.answers.empty()) throw std::invalid_argument("--battery and --answers are needed");
  return o;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("can't read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

Json json_of(const std::filesystem::path& file) {
  try {
    return Json::parse(text_of(file));
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
}

/// The cases with their answers. Throws where truth or answers are not those that were committed.
std::vector<Judged> read_cases(const Options& o) {
  const Json manifest = json_of(o.battery / "manifest.json");
  const std::string truth = text_of(o.battery / "sealed" / "truth.json");
  if (sha256_hex(text_of(o.battery / "sealed" / "salt") + truth) != manifest["truth_sha256"].text()) {
    throw std::runtime_error("the truth is not the one whose digest the manifest has");
  }
  const Json committed = json_of(o.answers / "manifest.json")["answers_sha256"];
  std::vector<Judged> cases;
  for (const Truth& t : read_truth(Json::parse(truth))) {
    Judged j{t, {}, Outcome::failed};
    const std::string digest = committed[t.number].text();
    if (digest.empty()) {
      j.answer.message = "no answer";
    } else {
      const std::string answer = text_of(o.answers / (t.number + ".json"));
      if (sha256_hex(answer) != digest)
        throw std::runtime_error("the answer to case " + t.number + " is not the one that was committed");
      j.answer = read_answer(Json::parse(answer));
    }
    j.outcome = judge(t, j.answer, o.twins, o.without);
    cases.push_back(std::move(j));
  }
  return cases;
}

bool run(const Options& o) {
  const auto cases = read_cases(o);
  const Score score = count(cases, o.limit, o.visible);
  const auto checks = checks_of(score, o.limits, o.limit, o.visible);
  const std::string text = report(cases, score, checks);
  if (o.out.empty()) {
    std::fputs(text.c_str(), stdout);
  } else {
    std::ofstream out(o.out, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw std::runtime_error("can't write " + o.out.string());
  }
  bool passed = true;
  for (const Check& c : checks) {
    if (!c.passed) std::fprintf(stderr, "battery_score: %s: %s, asked %s\n", c.what.c_str(), c.found.c_str(), c.asked.c_str());
    passed = passed && c.passed;
  }
  return passed;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(read_options(argc, argv)) ? 0 : 1;
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "battery_score: %s\n%s", e.what(), kUsage);
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "battery_score: %s\n", e.what());
    return 3;
  }
}
