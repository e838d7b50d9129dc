#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

const std::string kBlocks =
    "bodeflow: 1\nblocks:\n  sine: {block: generators.sine}\n  gain: {block: filters.gain}\n  hold: {block: filters.hold}\n"
    "  motor: {block: plants.motor}\n  dft: {block: spectrum.dft, period: 8}\n  log: {block: output.records}\n"
    "  tuner: {block: control.tuner}\n";

const std::string kWired =
    "connections:\n  - sine -> gain -> hold -> motor.voltage\n  - hold -> dft.input\n  - motor.angle -> dft.output\n  - dft -> "
    "log\n";

enum { sine, gain, hold, motor, dft, log, tuner };

}  // namespace

TEST_CASE("graph: a chain connects block by block, ports named where there are several") {
  const Phase phase = good(kBlocks + kWired).phases.at(0);
  REQUIRE(phase.streams.size() == 5);
  CHECK(phase.streams[0].from == End{sine, 0});
  CHECK(phase.streams[0].to == End{gain, 0});
  CHECK(phase.streams[1].from == End{gain, 0});
  CHECK(phase.streams[1].to == End{hold, 0});
  CHECK(phase.streams[2].to == End{motor, 0});
  CHECK(phase.streams[3].to == End{dft, 0});
  CHECK(phase.streams[4].from == End{motor, 1});
  CHECK(phase.streams[4].to == End{dft, 1});
  REQUIRE(phase.messages.size() == 1);
  CHECK(phase.messages[0].from == End{dft, 0});
  CHECK(phase.messages[0].to == End{log, 0});
  CHECK(phase.streams[1].place.line == 11);
  CHECK(phase.streams[1].place.column == 13);
}

TEST_CASE("graph: a port may be named in the middle of a chain") {
  const std::string text = kBlocks +
                           "connections:\n  - sine -> gain.in -> hold.out -> motor.voltage\n  - {from: hold, to: dft.input}\n"
                           "  - motor.current -> dft.output\n  - dft.response -> log.in\n";
  CHECK(good(text).phases[0].streams.size() == 5);
}

TEST_CASE("graph: a record waits for a time or for samples") {
  const auto latency = [](const std::string& text) {
    return good(kBlocks + kWired + "  - {from: tuner, to: log, latency: " + text + "}\n").phases[0].messages.at(1).latency;
  };
  CHECK(latency("2 ms").seconds == Rate(1, 500));
  CHECK(latency("2 ms").samples == 0);
  CHECK(latency("0.1").seconds == Rate(1, 10));
  CHECK(latency("3 samples").samples == 3);
  CHECK(latency("1 sample").samples == 1);
  CHECK(latency("3 samples").seconds == Rate(0, 1));
  CHECK(latency("0 s").seconds == Rate(0, 1));
}

TEST_CASE("graph: a block with live parameters has an input for their changes") {
  const Phase phase = good(kBlocks + kWired + "  - tuner -> gain.parameters\n").phases.at(0);
  CHECK(phase.messages.at(1).from == End{tuner, 0});
  CHECK(phase.messages.at(1).to == End{gain, kParameterPort});
}

TEST_CASE("graph: several senders may share a message input") {
  CHECK(good(kBlocks + kWired + "  - tuner -> log\n").phases[0].messages.size() == 2);
}

TEST_CASE("graph: a block may feed itself") {
  const Phase phase = good("bodeflow: 1\nblocks: {g: {block: filters.gain}}\nconnections: [g -> g]\n").phases.at(0);
  CHECK(phase.streams.at(0).from == End{0, 0});
  CHECK(phase.streams.at(0).to == End{0, 0});
}

TEST_CASE("graph: any element type goes with a port that takes any") {
  CHECK(good("bodeflow: 1\nblocks: {p: {block: generators.phasor}, g: {block: filters.gain}}\nconnections: [p -> g]\n")
            .phases[0]
            .streams.size() == 1);
}

TEST_CASE("graph: changes are scheduled in the order of time, then as written") {
  const Phase phase =
      good(kBlocks + kWired +
           "schedule:\n  - {at: 2 s, block: gain, set: {gain: 1}}\n  - {at: 500 ms, block: gain, set: {factor: 2}}\n"
           "  - {at: 2 s, block: gain, set: {gain: 3}}\n")
          .phases.at(0);
  REQUIRE(phase.schedule.size() == 3);
  CHECK(phase.schedule[0].time_s == 0.5);
  CHECK(phase.schedule[0].block == gain);
  CHECK(phase.schedule[0].parameter == 0);
  CHECK(phase.schedule[0].value.numbers == std::vector<double>{2.0});
  CHECK(phase.schedule[1].value.numbers == std::vector<double>{1.0});
  CHECK(phase.schedule[2].value.numbers == std::vector<double>{3.0});
}

TEST_CASE("graph: record keeps stream outputs, all or named") {
  const auto kept = [](const std::string& record) {
    std::vector<std::pair<int, int>> ports;
    const Graph graph = good(kBlocks + kWired + "record: " + record + "\n");
    for (const auto& r : graph.phases[0].recorded) ports.emplace_back(r.port.block, r.port.port);
    return ports;
  };
  using Ports = std::vector<std::pair<int, int>>;
  CHECK(kept("all") == Ports{{sine, 0}, {gain, 0}, {hold, 0}, {motor, 0}, {motor, 1}});
  CHECK(kept("[motor, gain.out, motor.angle]") == Ports{{motor, 0}, {motor, 1}, {gain, 0}});
  CHECK(kept("[dft, tuner.changes]").empty());
  CHECK(kept("[]").empty());
}

TEST_CASE("graph: the summary names results as result.json does, and what to type next") {
  const Graph graph = good(kBlocks + kWired + "summary: {show: [tuner, dft], next: type this}\n");
  CHECK(graph.summary.show == std::vector<std::string>{"tuner", "dft"});
  CHECK(graph.summary.next == "type this");
}

TEST_CASE("graph: hosts are noted in their blocks") {
  const Phase phase = good(kBlocks + kWired + "hosts: {bench: [motor, hold], desk-2: [dft]}\n").phases.at(0);
  CHECK(phase.blocks[motor].host == "bench");
  CHECK(phase.blocks[hold].host == "bench");
  CHECK(phase.blocks[dft].host == "desk-2");
  CHECK(phase.blocks[sine].host.empty());
}

}  // namespace bodeflow::graph
