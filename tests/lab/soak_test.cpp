// Memory of a run over hosts that streams for long: bounded, and flat.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "catch.hpp"
#include "lab.hpp"
#include "processes_of.hpp"

using namespace bodeflow::test;

namespace {

/// What a process may grow by from the first quarter to the end, in MB. 1.6 MB/s go there and back.
constexpr double kGrowth = 6.0;

void soak(int seconds) {
  TestLab lab;
  lab.agent("bench", {}, {}, seconds + 180);
  const std::string graph = "bodeflow: 1\nrun: {clock: realtime, duration: " + std::to_string(seconds) + R"( s, seed: 1}
blocks:
  source: {block: generators.noise, sample_rate: 100 kHz, channels: 2}
  there: {block: filters.gain, gain: 2}
  back: {block: filters.gain, gain: 0.5}
  part: {block: filters.decimate, factor: 1000}
connections: [source -> there -> back -> part]
record: [part.out]
hosts: {bench: [there]}
)";
  Process run(lab.run(lab.folder().write("soak.yaml", graph).string(), "out"), seconds + 120);
  lab.begun("bench");
  const auto begin = Clock::now();
  std::map<int, double> early, late;  // MB by process: most in the first quarter, most in the last one
  while (since_s(begin) < seconds) {
    const double at = since_s(begin) / seconds;
    for (const int process : processes_with({lab.folder().path().string()})) {
      if (at < 0.25) early[process] = std::max(early[process], resident_mb(process));
      if (at > 0.75) late[process] = std::max(late[process], resident_mb(process));
    }
    sleep_s(0.5);
  }
  const int code = run.wait();
  INFO(run.output());
  REQUIRE(code == 0);
  CHECK(late.size() >= 4);  // agent, launcher, two parts
  for (const auto& [process, most] : late) {
    INFO(early[process] << " MB in the first quarter, " << most << " MB in the last one");
    CHECK(most - early[process] < kGrowth);
  }
  for (const auto& link : lab.links("out")) {
    CHECK(link["samples"] == 100000.0 * seconds);
    CHECK(link["gaps"] == 0);
  }
}

}  // namespace

TEST_CASE("lab: a minute of streaming leaves memory flat", "[.minutes]") { soak(60); }

TEST_CASE("lab: an hour of streaming leaves memory flat", "[long]") {
  const char* given = std::getenv("BODEFLOW_SOAK_SECONDS");
  soak(given == nullptr ? 3600 : std::max(8, std::atoi(given)));
}
