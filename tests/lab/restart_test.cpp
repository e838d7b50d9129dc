// A host that is lost in the middle of a run and started again: what is missing, to the sample.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include "catch.hpp"
#include "lab.hpp"
#include "processes_of.hpp"

using namespace bodeflow::test;
using nlohmann::json;

namespace {

/// A gain on the bench: what comes back is twice what went there, but where samples are missing.
const char* const kThere = R"(bodeflow: 1
run: {clock: realtime, duration: 8 s, seed: 1, restart: true}
blocks:
  excitation: {block: generators.noise, sample_rate: 1 kHz, std: 1}
  twice: {block: filters.gain, gain: 2}
  back: {block: filters.gain, gain: 1}
connections: [excitation -> twice -> back]
record: [excitation.out, back.out, twice.out]
hosts: {bench: [twice]}
)";

/// A source on the bench that begins anew, a filter between two other hosts that remembers nothing, and who listens to it.
const char* const kChain = R"(bodeflow: 1
run: {clock: realtime, duration: 8 s, seed: 1, restart: true}
blocks:
  source: {block: generators.sine, sample_rate: 1 kHz, frequency: 7.3 Hz}
  twice: {block: filters.gain, gain: 2}
  thrice: {block: filters.gain, gain: 3}
connections: [source -> twice -> thrice]
record: [thrice.out]
hosts: {bench: [source], middle: [twice]}
)";

const std::string kLoop = closed_loop("clock: realtime, duration: 8 s, seed: 1, restart: true, gaps: hold");

/// Kills the process of a host's part, the first or one that goes on for a lost one, a second after its phase has begun.
void kill_part(TestLab& lab, const std::string& host, int epoch = 0) {
  const std::string run = lab.begun(host, epoch);
  sleep_s(1.0);
  const auto processes = processes_with({"part-worker", run});
  REQUIRE(processes.size() == 1);
  kill(processes.front(), SIGKILL);
}

/// The one gap of connection "twice.out -> back.in", with every other sample of the run checked.
void check_samples(TestLab& lab, Process& run) {
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  const json manifest = lab.manifest("out");
  REQUIRE(manifest["gaps"].size() == 1);
  const json& gap = manifest["gaps"][0];
  CHECK(gap["epoch"] == 1);
  const auto first = gap["first"].get<std::size_t>(), count = gap["count"].get<std::size_t>();
  CHECK(count > 100);
  const auto sent = lab.stream("out/data.h5", "excitation.out"), back = lab.stream("out/data.h5", "back.out");
  REQUIRE(sent.size() == 8000);
  REQUIRE(back.size() == 8000);
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < back.size(); ++n) {
    const bool missing = n >= first && n < first + count;
    if (missing ? !std::isnan(back[n]) : back[n] != 2.0 * sent[n]) ++wrong;
  }
  INFO("missing from " << first << ", " << count);
  CHECK(wrong == 0);
  CHECK(run.output().find(std::to_string(count) + " samples are missing from sample " + std::to_string(first) + " on") !=
        std::string::npos);
  // What the bench recorded lies beside, in two pieces.
  const auto later = lab.stream("out/restarted/bench/data.h5", "twice.out");
  REQUIRE(later.size() == 8000 - first - count);
  CHECK(std::equal(later.begin(), later.end(), back.end() - static_cast<std::ptrdiff_t>(later.size())));
  const auto earlier = lab.stream("out/restarted/bench/epoch_0/data.h5", "twice.out");
  CHECK(
      std::equal(earlier.begin(), earlier.begin() + static_cast<std::ptrdiff_t>(std::min(first, earlier.size())), back.begin()));
}

}  // namespace

TEST_CASE("lab: a part that is killed is started again and every sample is right or told to be missing") {
  TestLab lab;
  lab.agent("bench");
  Process run(lab.run(lab.folder().write("there.yaml", kThere).string(), "out"));
  kill_part(lab, "bench");
  check_samples(lab, run);
}

TEST_CASE("lab: an agent that is killed with its part and comes back goes on with the run") {
  TestLab lab;
  lab.agent("bench");
  Process run(lab.run(lab.folder().write("there.yaml", kThere).string(), "out"));
  kill_part(lab, "bench");
  lab.crash("bench");
  lab.agent("bench");
  check_samples(lab, run);
}

TEST_CASE("lab: a loop over hosts holds the last sample where its motor was lost") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  Process run(lab.run(lab.folder().write("loop.yaml", kLoop).string(), "out"));
  kill_part(lab, "bench");
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  const json gaps = lab.manifest("out")["gaps"];
  CHECK(gaps.size() == 2);  // of the controller and of this machine
  const auto speed = lab.stream("out/data.h5", "speed.out");
  REQUIRE(speed.size() == 800);
  REQUIRE(lab.stream("out/data.h5", "pi.out").size() == 800);
  for (const json& gap : gaps) {
    if (gap["host"] != "") continue;
    const auto first = gap["first"].get<std::size_t>(), end = first + gap["count"].get<std::size_t>();
    REQUIRE(first > 0);
    for (std::size_t n = first; n < end; ++n) CHECK(speed[n] == speed[first - 1]);
    CHECK(speed[end] == 0.0);  // a motor that has forgotten its speed
  }
}

TEST_CASE("lab: a loop over hosts goes on where its controller was lost, which both of its neighbours wait for") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  Process run(lab.run(lab.folder().write("loop.yaml", kLoop).string(), "out"));
  kill_part(lab, "controller");
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  const json manifest = lab.manifest("out");
  REQUIRE(manifest["gaps"].size() == 1);
  CHECK(manifest["gaps"][0]["host"] == "bench");
  REQUIRE(manifest["restarts"].size() == 1);
  CHECK(manifest["restarts"][0]["host"] == "controller");
  const auto speed = lab.stream("out/data.h5", "speed.out");
  REQUIRE(speed.size() == 800);
  CHECK(std::none_of(speed.begin(), speed.end(), [](double value) { return std::isnan(value); }));
}

TEST_CASE("lab: a source that is lost begins anew behind the gap, and the host between is told of none when it goes") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("middle");
  const auto graph = lab.folder().write("chain.yaml", kChain).string();
  std::string simulated = kChain;
  simulated.replace(simulated.find("realtime"), 8, "simulated");
  Process here(lab.run_here(lab.folder().write("here.yaml", simulated).string(), "here"));
  REQUIRE(here.wait() == 0);
  const auto expected = lab.stream("here/data.h5", "thrice.out");
  for (const std::string& host : {std::string("bench"), std::string("middle")}) {
    Process run(lab.run(graph, host));
    kill_part(lab, host);
    const int code = run.wait();
    INFO(run.output());
    REQUIRE(code == 0);
    const json manifest = lab.manifest(host);
    CHECK(manifest["status"] == "complete");
    REQUIRE(manifest["gaps"].size() == 1);
    const json& gap = manifest["gaps"][0];
    CHECK(gap["connection"] == (host == "bench" ? "source.out -> twice.in" : "twice.out -> thrice.in"));
    CHECK(gap["host"] == (host == "bench" ? "middle" : ""));
    const auto first = gap["first"].get<std::size_t>(), end = first + gap["count"].get<std::size_t>();
    REQUIRE(manifest["restarts"].size() == 1);
    CHECK(std::lround(1000.0 * manifest["restarts"][0]["begin_s"].get<double>()) == static_cast<long>(end));
    const auto got = lab.stream(host + "/data.h5", "thrice.out");
    REQUIRE(got.size() == expected.size());
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < got.size(); ++n) {
      const bool missing = n >= first && n < end;
      const bool anew = host == "bench" && n >= end;
      if (missing ? !std::isnan(got[n]) : got[n] != expected[anew ? n - end : n]) ++wrong;
    }
    INFO("missing from " << first << " to " << end);
    CHECK(wrong == 0);
    for (int i = 0; i < 200 && !(lab.runs_of("bench").empty() && lab.runs_of("middle").empty()); ++i) sleep_s(0.05);
    CHECK(lab.runs_of(host).empty());
  }
}

TEST_CASE("lab: a part that is lost again and again ends the run at the fourth time") {
  TestLab lab;
  lab.agent("bench");
  std::string longer = kThere;
  longer.replace(longer.find("8 s"), 3, "50 s");
  Process run(lab.run(lab.folder().write("there.yaml", longer).string(), "out"));
  for (const int epoch : {0, 1, 2, 3}) kill_part(lab, "bench", epoch);
  const int code = run.wait();
  INFO(run.output());
  CHECK(code == 1);
  CHECK(run.output().find("host 'bench' is lost for the 4th time in this run: it is not started again") != std::string::npos);
  const json manifest = lab.manifest("out");
  CHECK(manifest["restarts"].size() == 3);
  REQUIRE(manifest["gaps"].size() == 3);
  const auto sent = lab.stream("out/data.h5", "excitation.out"), back = lab.stream("out/data.h5", "back.out");
  REQUIRE(back.size() > 1000);
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < back.size(); ++n) {
    const bool missing = std::any_of(manifest["gaps"].begin(), manifest["gaps"].end(), [&](const json& gap) {
      return n >= gap["first"].get<std::size_t>() && n - gap["first"].get<std::size_t>() < gap["count"].get<std::size_t>();
    });
    if (missing ? !std::isnan(back[n]) : back[n] != 2.0 * sent[n]) ++wrong;
  }
  CHECK(wrong == 0);
}

TEST_CASE("lab: a restart is refused by name where records go over hosts and where no number would go round a loop") {
  TestLab lab;
  lab.agent("bench");
  lab.agent("controller");
  std::string loop = kLoop;
  loop.replace(loop.find(", gaps: hold"), 12, "");
  Process first(lab.run(lab.folder().write("loop.yaml", loop).string(), "loop"));
  CHECK(first.wait() == 3);
  CHECK(first.output().find("closes a loop over hosts, in which samples that are no number never end; 'gaps: hold'") !=
        std::string::npos);
  Process second(lab.run(lab.folder()
                             .write("records.yaml", R"(bodeflow: 1
run: {clock: simulated, duration: 4 s, restart: true}
blocks:
  excitation: {block: generators.multisine, sample_rate: 500 Hz, period: 500, lines: {first: 1, last: 99, step: 2}}
  response: {block: spectrum.averaging_dft, period: 500, form: known_input, lines: {first: 1, last: 99, step: 2}}
  model: {block: sanathanan_koerner.model, order: 2}
connections: [excitation -> response.output, excitation -> response.input, response -> model.response]
hosts: {bench: [excitation, response]}
)")
                             .string(),
                         "records"));
  CHECK(second.wait() == 3);
  INFO(second.output());
  CHECK(second.output().find("run: restart: records go over hosts from response.") != std::string::npos);
  CHECK(second.output().find("-> model.response: those that a lost host did not send can't be told") != std::string::npos);
}
