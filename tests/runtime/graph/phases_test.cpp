#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

const std::string kTuner = "    blocks: {tuner: {block: control.tuner}, sine: {block: generators.sine}}\n";

Graph phased(const std::string& second) {
  return good("bodeflow: 1\nrun: {duration: 2 s, seed: 7, chunk: 64}\nphases:\n  - name: one\n" + kTuner + "  - name: two\n" +
              kTuner + second);
}

}  // namespace

TEST_CASE("graph: one without phases is one phase without a name") {
  const Graph graph = good("bodeflow: 1\ntitle: Alone\nblocks: {a: {block: generators.sine}}\n");
  REQUIRE(graph.phases.size() == 1);
  CHECK(graph.phases[0].name.empty());
  CHECK(graph.title == "Alone");
  CHECK(graph.file == "g.yaml");
  CHECK(graph.phases[0].block_index("a") == 0);
  CHECK(graph.phases[0].block_index("b") == -1);
}

TEST_CASE("graph: run settings have units and defaults") {
  const RunSettings none = good("bodeflow: 1\nblocks: {a: {block: generators.sine}}\n").phases[0].run;
  CHECK(none.clock == Clock::simulated);
  CHECK_FALSE(none.duration_s);
  CHECK(none.seed == 1);
  CHECK(none.chunk == 1024);
  CHECK(none.threads == 1);
  const RunSettings all =
      good(
          "bodeflow: 1\nrun: {clock: realtime, duration: 1 min, seed: 18446744073709551615, chunk: 256, latency: 5 ms, "
          "threads: 2, watchdog: 3}\nblocks: {a: {block: generators.sine}}\n")
          .phases[0]
          .run;
  CHECK(all.clock == Clock::realtime);
  CHECK(all.duration_s == 60.0);
  CHECK(all.seed == 18446744073709551615u);
  CHECK(all.chunk == 256);
  CHECK(all.latency_s == 5e-3);
  CHECK(all.threads == 2);
  CHECK(all.watchdog_s == 3.0);
}

TEST_CASE("graph: real-time settings have defaults and values") {
  const RunSettings none = good("bodeflow: 1\nblocks: {a: {block: generators.sine}}\n").phases[0].run;
  CHECK(none.on_overrun == Overrun::count);
  CHECK_FALSE(none.priority);
  CHECK(none.cores.empty());
  const RunSettings all =
      good(
          "bodeflow: 1\nrun: {clock: realtime, on_overrun: skip, priority: 80, cores: [1, 0]}\nblocks: {a: {block: "
          "generators.sine}}\n")
          .phases[0]
          .run;
  CHECK(all.on_overrun == Overrun::skip);
  CHECK(all.priority == 80);
  CHECK(all.cores == std::vector<int>{1, 0});
}

TEST_CASE("graph: a device with streams may pace a run") {
  const Graph graph = good("bodeflow: 1\nrun: {clock: hardware}\nblocks: {a: {block: acquisition.card}}\n");
  CHECK(graph.phases[0].run.clock == Clock::hardware);
}

TEST_CASE("graph: a phase has the graph's run settings, and its own over them") {
  const Graph graph = phased("    run: {seed: 8, clock: realtime}\n");
  CHECK(graph.phases[0].run.seed == 7);
  CHECK(graph.phases[1].run.seed == 8);
  CHECK(graph.phases[1].run.duration_s == 2.0);
  CHECK(graph.phases[1].run.chunk == 64);
  CHECK(graph.phases[1].run.clock == Clock::realtime);
}

TEST_CASE("graph: a phase takes records of an earlier one") {
  const Graph graph =
      good("bodeflow: 1\nphases:\n  - name: one\n" + kTuner +
           "  - name: two\n    blocks: {log: {block: output.records}, gain: {block: filters.gain}, s: {block: generators.sine}}\n"
           "    connections: [$one.tuner.changes -> log, $one.tuner -> gain.parameters, s -> gain]\n");
  const auto& references = graph.phases[1].references;
  REQUIRE(references.size() == 2);
  CHECK(references[0].phase == "one");
  CHECK(references[0].block == "tuner");
  CHECK(references[0].port == "changes");
  CHECK(references[0].to == End{0, 0});
  CHECK(references[1].port == "changes");
  CHECK(references[1].to == End{1, kParameterPort});
}

TEST_CASE("graph: conditions compare an attribute of a record") {
  const auto when = [](const std::string& text) { return *phased("    when: " + text + "\n").phases[1].when; };
  const Condition truth = when("$one.tuner.converged");
  CHECK(truth.phase == "one");
  CHECK(truth.block == "tuner");
  CHECK(truth.port == "changes");
  CHECK(truth.attribute == "converged");
  CHECK(truth.comparison.empty());
  CHECK(when("$one.tuner.changes.error <= 2.5").comparison == "<=");
  CHECK(std::get<double>(when("$one.tuner.changes.error <= 2.5").value) == 2.5);
  CHECK(std::get<double>(when("$one.tuner.error>-1e3").value) == -1e3);
  CHECK(std::get<bool>(when("$one.tuner.ok == false").value) == false);
  CHECK(std::get<std::string>(when("$one.tuner.form == known_input").value) == "known_input");
  CHECK(std::get<std::string>(when("$one.tuner.form != 'true'").value) == "true");
  CHECK(when("$one.tuner.form != 'true'").comparison == "!=");
}

TEST_CASE("graph: a phase repeats until its own record says so") {
  const Phase phase = phased("    repeat: {max: 5, until: $two.tuner.error < 0.1}\n").phases[1];
  CHECK(phase.repeat_max == 5);
  CHECK(phase.until->phase == "two");
  CHECK(phase.until->comparison == "<");
}

TEST_CASE("graph: a sweep lists the values of every axis") {
  const Phase phase = phased("    sweep: {seed: 3..6, sine.frequency: [1 Hz, 2 kHz], run.duration: [1 s]}\n").phases[1];
  REQUIRE(phase.sweep.size() == 3);
  CHECK(phase.sweep[0].path == "seed");
  CHECK(phase.sweep[0].values == std::vector<std::string>{"3", "4", "5", "6"});
  CHECK(phase.sweep[1].path == "sine.frequency");
  CHECK(phase.sweep[1].values == std::vector<std::string>{"1 Hz", "2 kHz"});
}

TEST_CASE("graph: every value of a sweep can be set in the expanded graph") {
  const Graph graph = phased("    sweep: {sine.frequency: [1 Hz, 2 kHz]}\n");
  for (const auto& value : graph.phases[1].sweep[0].values) {
    const Graph one = good(graph.expanded, {{{"two.sine.frequency", value}}, {}});
    CHECK(one.phases[0].blocks[1].parameters[0].numbers[0] == 1.0);
    CHECK(one.phases[1].blocks[1].parameters[0].numbers[0] == (value == "1 Hz" ? 1.0 : 2000.0));
    CHECK(one.phases[1].blocks[1].parameters[0].given);
  }
}

TEST_CASE("graph: plugins of the required versions are accepted") {
  CHECK(good("bodeflow: 1\nrequires: {filters: '>=1.2', plants: 1.2.3, others: '>1.2.2, <2', generators: ==1.2.3}\n"
             "blocks: {a: {block: generators.sine}}\n")
            .phases.size() == 1);
}

}  // namespace bodeflow::graph
