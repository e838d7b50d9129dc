#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

bool same(const Latency& a, const Latency& b) { return a.seconds == b.seconds && a.samples == b.samples; }

bool same(const std::optional<Condition>& a, const std::optional<Condition>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->phase == b->phase && a->block == b->block && a->port == b->port && a->attribute == b->attribute &&
         a->comparison == b->comparison && a->value == b->value;
}

void check_same(const RunSettings& a, const RunSettings& b) {
  CHECK(a.clock == b.clock);
  CHECK(a.duration_s == b.duration_s);
  CHECK(a.seed == b.seed);
  CHECK(a.chunk == b.chunk);
  CHECK(a.latency_s == b.latency_s);
  CHECK(a.threads == b.threads);
  CHECK(a.watchdog_s == b.watchdog_s);
}

template <class T, class Equal>
void check_all(const std::vector<T>& a, const std::vector<T>& b, Equal equal) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(equal(a[i], b[i]));
}

/// Everything but places.
void check_same(const Phase& a, const Phase& b) {
  CHECK(a.name == b.name);
  check_all(a.blocks, b.blocks, [](const Block& x, const Block& y) {
    return x.name == y.name && x.type == y.type && x.parameters == y.parameters && x.host == y.host;
  });
  check_all(a.streams, b.streams, [](const StreamEdge& x, const StreamEdge& y) { return x.from == y.from && x.to == y.to; });
  check_all(a.messages, b.messages, [](const MessageEdge& x, const MessageEdge& y) {
    return x.from == y.from && x.to == y.to && same(x.latency, y.latency);
  });
  check_all(a.references, b.references, [](const Reference& x, const Reference& y) {
    return x.phase == y.phase && x.block == y.block && x.port == y.port && x.to == y.to;
  });
  check_all(a.schedule, b.schedule, [](const ScheduledChange& x, const ScheduledChange& y) {
    return x.time_s == y.time_s && x.block == y.block && x.parameter == y.parameter && x.value == y.value;
  });
  check_all(a.recorded, b.recorded,
            [](const RecordedPort& x, const RecordedPort& y) { return x.port == y.port && x.kind == y.kind; });
  check_all(a.sweep, b.sweep, [](const SweepAxis& x, const SweepAxis& y) { return x.path == y.path && x.values == y.values; });
  check_same(a.run, b.run);
  CHECK(same(a.when, b.when));
  CHECK(same(a.until, b.until));
  CHECK(a.repeat_max == b.repeat_max);
}

void check_round_trip(const std::string& text, const LoadOptions& options = {}) {
  const Graph first = good(text, options);
  const auto again = load_text(first.expanded, "/elsewhere/expanded.yaml", {}, test_registry());
  if (!again) FAIL(to_string(again.error()) + "\n" + first.expanded);
  CHECK(again->title == first.title);
  CHECK(again->expanded == first.expanded);
  REQUIRE(again->phases.size() == first.phases.size());
  for (std::size_t i = 0; i < first.phases.size(); ++i) check_same(first.phases[i], again->phases[i]);
}

const std::string kFlat = R"y(# a comment
bodeflow: 1
title: "Motor: one band, ${band} # 2"
run: {clock: simulated, duration: 8.192 s, seed: 4, latency: 1 ms}
variables: {band: low, rate: 250 Hz, lines: {first: 3, last: 49, step: 2}}
requires: {filters: ">=1.2, <2"}
blocks:
  excitation: {block: generators.multisine, sample_rate: "${rate}", period: 128, lines: "${lines}", amplitude: 4 V}
  hold:       {block: filters.hold, factor: 40}
  motor:
    block: plants.motor
    rs: 6.6 ohm       # cold
  file:
    block: acquisition.file
    file: data/x y.csv
    columns: [a, "b, c", "true", "", "~", "${band}", "- x", "it's", "{", "a: b", "#"]
    rows: 1:5
    note: "line one\nline two\ttab \\ \"quoted\" $${band} µ"
  dft: {block: spectrum.dft, period: 5120, skip: 2}
  tuner: {block: control.tuner}
  gain: {block: filters.gain, factor: 50 %}
  plant: {block: plants.linear, A: [[1, 2], [3, 4]], poles: [-1+2j, [1, 2], -3, j], numerator: 1e3, delay: 2 us}
  log: {block: output.records}
connections:
  - excitation -> hold -> motor.voltage
  - motor.current -> dft.output
  - hold -> dft.input
  - dft -> log
  - file -> gain -> plant
  - {from: tuner, to: gain.parameters, latency: 3 samples}
schedule:
  - {at: 500 ms, block: gain, set: {gain: 3}}
record: [motor, gain.out, dft]
hosts: {bench: [excitation, hold, motor]}
summary: {show: [dft], next: "bodeflow identify FILE --input u"}
)y";

const std::string kPhased = R"y(bodeflow: 1
run: {duration: 2 s}
phases:
  - name: one
    blocks:
      tuner: {block: control.tuner}
      sine: {block: generators.sine}
    sweep: {seed: 1..3, sine.frequency: [1 Hz, 2 Hz]}
  - name: two
    run: {clock: realtime, watchdog: 5 s}
    blocks: {log: {block: output.records}, tuner: {block: control.tuner}}
    connections: [$one.tuner.changes -> log]
    when: "$one.tuner.ok != 'no: never'"
    repeat: {max: 3, until: "$two.tuner.error <= 1e-3"}
    record: all
)y";

}  // namespace

TEST_CASE("expand: the expanded graph is the same graph") {
  check_round_trip(kFlat);
  check_round_trip(kPhased);
}

TEST_CASE("expand: overrides are part of it") {
  LoadOptions options{{{"rate", "1 kHz"},
                       {"plant.A", "[[1]]"},
                       {"motor.rs", "7"},
                       {"gain.gain", "2"},
                       {"run.threads", "2"},
                       {"file.file", "q.csv"}},
                      99};
  check_round_trip(kFlat, options);
  const std::string text = good(kFlat, options).expanded;
  CHECK(text.find("sample_rate: 1 kHz") != std::string::npos);
  CHECK(text.find("rs: 7\n") != std::string::npos);
  CHECK(text.find("seed: 99") != std::string::npos);
  CHECK(text.find("variables") == std::string::npos);
}

TEST_CASE("expand: it reads as the user wrote it, in the same order") {
  const std::string text =
      "bodeflow: 1\ntitle: Two blocks, one connection\nblocks:\n  sine: {block: generators.sine, frequency: 10 Hz}\n  gain:\n    "
      "block: filters.gain\n"
      "    gain: -2.5\nconnections:\n  - sine -> gain\nrun: {duration: 1 s}\n";
  CHECK(good(text).expanded == text);
}

TEST_CASE("expand: a long line in brackets becomes an indented block") {
  std::string columns = "[";
  for (int i = 0; i < 60; ++i) columns += (i == 0 ? "c" : ", c") + std::to_string(i);
  const std::string text = "bodeflow: 1\nblocks: {f: {block: acquisition.file, file: /x, columns: " + columns + "]}}\n";
  CHECK(good(text).expanded.find(
            "blocks:\n  f:\n    block: acquisition.file\n    file: /x\n    columns:\n      - c0\n      - c1\n") !=
        std::string::npos);
  check_round_trip(text);
}

}  // namespace bodeflow::graph
