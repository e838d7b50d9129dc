// Parts whose processes are gone, with and without others in their place: what is said, and what every sample is.
#include <algorithm>
#include <cmath>
#include <csignal>

#include "catch.hpp"
#include "lab.hpp"
#include "processes_of.hpp"

using namespace bodeflow::test;
using nlohmann::json;

namespace {

/// A gain on the bench and one on the middle, between a source and who listens.
std::string chain(const std::string& run) {
  return "bodeflow: 1\nrun: {clock: realtime, seed: 1, " + run + R"(}
blocks:
  source: {block: generators.sine, sample_rate: 1 kHz, frequency: 7.3 Hz}
  twice: {block: filters.gain, gain: 2}
  thrice: {block: filters.gain, gain: 3}
connections: [source -> twice -> thrice]
record: [thrice.out]
hosts: {bench: [source], middle: [twice]}
)";
}

/// Kills the process of the part in that folder.
void kill_part(const std::string& run) {
  for (const int process : processes_with({"part-worker", run})) kill(process, SIGKILL);
}

std::vector<double> expected_here(TestLab& lab, std::string text) {
  (void)lab.hashes_here(std::move(text));
  return lab.stream("here/data.h5", "thrice.out");
}

}  // namespace

TEST_CASE("lab: a part that is killed ends the run at once, with the agent's word for it, and not after the tolerance") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("middle");
  Process run(lab.run(lab.folder().write("chain.yaml", chain("duration: 50 s, tolerance: 45 s")).string(), "out"));
  const std::string bench = lab.begun("bench");
  sleep_s(1.0);
  const auto killed = Clock::now();
  kill_part(bench);
  const int code = run.wait();
  INFO(run.output());
  CHECK(code == 1);
  CHECK(since_s(killed) < 30.0);
  CHECK(run.output().find("host 'bench' is lost: its process was ended by signal 9 (Killed)") != std::string::npos);
  CHECK(lab.manifest("out")["status"] == "failed");
  CHECK(lab.stream("out/data.h5", "thrice.out").size() > 100);
}

TEST_CASE("lab: a part that is killed while the run starts is told by name") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("middle");
  const auto graph = lab.folder().write("chain.yaml", chain("duration: 5 s, tolerance: 45 s, restart: true")).string();
  Process run(lab.run(graph, "out"));
  const int part = lab.part_of("bench");
  REQUIRE(part > 0);
  kill(part, SIGKILL);
  const int code = run.wait();
  INFO(run.output());
  CHECK((code == 5 || code == 1));  // before or behind the begin of the first phase
  CHECK(run.output().find("host 'bench' is lost: its process was ended by signal 9 (Killed)") != std::string::npos);
}

TEST_CASE("lab: two hosts that are lost at once are started again together") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("middle");
  const std::string text = chain("duration: 10 s, restart: true");
  const auto expected = expected_here(lab, text);
  Process run(lab.run(lab.folder().write("chain.yaml", text).string(), "out"));
  const std::string bench = lab.begun("bench"), middle = lab.begun("middle");
  sleep_s(1.0);
  kill_part(bench);
  kill_part(middle);
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  const json manifest = lab.manifest("out");
  REQUIRE(manifest["restarts"].size() == 2);
  const double begin_s = manifest["restarts"][0]["begin_s"];
  CHECK(manifest["restarts"][1]["begin_s"] == begin_s);
  CHECK(manifest["restarts"][0]["epoch"] == manifest["restarts"][1]["epoch"]);
  REQUIRE(manifest["gaps"].size() == 1);
  const json& gap = manifest["gaps"][0];
  CHECK(gap["connection"] == "twice.out -> thrice.in");
  const auto first = gap["first"].get<std::size_t>(), end = first + gap["count"].get<std::size_t>();
  CHECK(std::lround(1000.0 * begin_s) == static_cast<long>(end));
  const auto got = lab.stream("out/data.h5", "thrice.out");
  REQUIRE(got.size() == expected.size());
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < got.size(); ++n)
    if (n >= first && n < end ? !std::isnan(got[n]) : got[n] != expected[n >= end ? n - end : n]) ++wrong;
  INFO("missing from " << first << " to " << end);
  CHECK(wrong == 0);
  CHECK(text_of(lab.path("out/report.html")).find("Missing samples") != std::string::npos);
}

TEST_CASE("lab: a host that is lost again while its part is started anew is started once more") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("middle");
  const std::string text = chain("duration: 12 s, restart: true");
  const auto expected = expected_here(lab, text);
  Process run(lab.run(lab.folder().write("chain.yaml", text).string(), "out"));
  const std::string middle = lab.begun("middle");
  sleep_s(1.0);
  kill_part(middle);
  for (const auto begin = Clock::now(); since_s(begin) < 20.0; sleep_s(0.01))
    if (!processes_with({"part-worker", middle + "-1"}).empty()) break;
  kill_part(middle + "-1");
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  const json manifest = lab.manifest("out");
  REQUIRE(manifest["restarts"].size() == 1);
  CHECK(manifest["restarts"][0]["epoch"] == 2);
  REQUIRE(manifest["gaps"].size() == 1);
  const auto first = manifest["gaps"][0]["first"].get<std::size_t>(), count = manifest["gaps"][0]["count"].get<std::size_t>();
  const auto got = lab.stream("out/data.h5", "thrice.out");
  REQUIRE(got.size() == expected.size());
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < got.size(); ++n)
    if (n >= first && n < first + count ? !std::isnan(got[n]) : got[n] != expected[n]) ++wrong;
  CHECK(wrong == 0);
}

TEST_CASE("lab: samples of a host that is lost in the last seconds are missing to the end of the run") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("middle");
  const std::string text = chain("duration: 3 s, restart: true");
  const auto expected = expected_here(lab, text);
  Process run(lab.run(lab.folder().write("chain.yaml", text).string(), "out"));
  const std::string middle = lab.begun("middle");
  sleep_s(1.5);
  kill_part(middle);
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  const json gaps = lab.manifest("out")["gaps"];
  REQUIRE(gaps.size() == 1);
  const auto first = gaps[0]["first"].get<std::size_t>(), count = gaps[0]["count"].get<std::size_t>();
  const auto got = lab.stream("out/data.h5", "thrice.out");
  REQUIRE(got.size() == expected.size());
  CHECK(first + count <= got.size());
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < got.size(); ++n)
    if (n >= first && n < first + count ? !std::isnan(got[n]) : got[n] != expected[n]) ++wrong;
  CHECK(wrong == 0);
}
