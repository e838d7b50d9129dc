// Hosts that others wait for: slow ones and late ones. Nothing is lost, and memory stays bounded.
#include <algorithm>

#include "catch.hpp"
#include "lab.hpp"
#include "processes_of.hpp"

using namespace bodeflow::test;
using nlohmann::json;

TEST_CASE("lab: a host that computes slower than its source holds it back in bounded memory, and top tells so") {
  // 96 MB go to a filter that takes a few seconds for them; the source alone would need a few tenths of a second.
  constexpr double kSamples = 3e6;
  TestLab lab;
  lab.agent("bench");
  const std::string text = R"(bodeflow: 1
run: {clock: simulated, duration: 300 s, seed: 1}
blocks:
  source: {block: generators.noise, sample_rate: 10 kHz, channels: 4}
  slow: {block: filters.fir, taps: 8001, edges: [1 kHz]}
  part: {block: filters.decimate, factor: 100}
connections: [source -> slow -> part]
record: [part.out]
hosts: {bench: [slow, part]}
)";
  const json hashes = lab.hashes_here(text);
  Process run(lab.run(lab.folder().write("slow.yaml", text).string(), "hosts"), 240);
  lab.begun("bench");
  const int receiver = lab.part_of("bench");
  const auto senders = processes_with({"part-worker", lab.path("hosts")});
  REQUIRE(senders.size() == 1);
  const double sender_begin = resident_mb(senders.front()), receiver_begin = resident_mb(receiver);
  const json runs = lab.top();
  double sender_most = 0.0, receiver_most = 0.0;
  for (double now = sender_begin; now > 0.0; sleep_s(0.02)) {
    now = resident_mb(senders.front());
    sender_most = std::max(sender_most, now);
    receiver_most = std::max(receiver_most, resident_mb(receiver));
  }
  lab.require_complete(run, "hosts", hashes);
  INFO("sender " << sender_begin << " to " << sender_most << " MB, receiver " << receiver_begin << " to " << receiver_most
                 << " MB");
  CHECK(sender_most - sender_begin < 40.0);
  CHECK(receiver_most - receiver_begin < 40.0);

  INFO(runs.dump(1));
  REQUIRE(runs.size() == 1);
  REQUIRE(runs[0]["hosts"].size() == 2);
  const json& link = runs[0]["hosts"][0]["links"].at(0);
  CHECK(link["sends"] == true);
  CHECK(link["other"] == "bench");
  CHECK(link["samples"].get<double>() < kSamples);
  CHECK(link["waited_s"].get<double>() > 0.2);
  CHECK(link["queued_bytes"].get<double>() > 0.0);
  CHECK(link["queued_bytes"].get<double>() <= 4.0 * (1 << 20));
  const auto links = lab.links("hosts");
  CHECK(links.size() == 2);
  for (const json& one : links) {
    CHECK(one["samples"] == kSamples);
    CHECK(one["gaps"] == 0);
  }
}

TEST_CASE("lab: nothing is written before a host has come that comes up seconds after the others") {
  TestLab lab;
  lab.agent("bench", {}, {"env", "ASAN_OPTIONS=verify_asan_link_order=0", "LD_PRELOAD=" LATE_PART});
  lab.agent("controller");
  const std::string text = closed_loop("clock: realtime, duration: 1 s, seed: 1");
  const json hashes = lab.hashes_here(text);
  const auto begin = Clock::now();
  Process run(lab.run(lab.folder().write("loop.yaml", text).string(), "hosts"));
  lab.begun("controller");
  CHECK(since_s(begin) > 3.0);
  lab.require_complete(run, "hosts", hashes);
  const auto links = lab.links("hosts");
  CHECK(links.size() == 8);
  for (const json& link : links) {
    CHECK(link["samples"] == loop_samples(link, 100));
    CHECK(link["gaps"] == 0);
    CHECK(link["reconnects"] == 0);
  }
}
