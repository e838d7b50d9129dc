#include "catch.hpp"
#include "graph/live_value.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

/// A parameter of the one block of a graph.
const ParameterValue& value(const Graph& graph, const std::string& name) {
  const Block& block = graph.phases.at(0).blocks.at(0);
  return block.parameters.at(static_cast<std::size_t>(block.type->parameter(name)));
}

Graph with(const std::string& block, const std::string& parameters) {
  return good("bodeflow: 1\nblocks:\n  sine: {block: generators.sine}\n  x: {block: " + block + ", " + parameters +
              "}\nconnections: [sine -> x]\n");
}

const ParameterValue& second(const Graph& graph, const std::string& name) {
  const Block& block = graph.phases.at(0).blocks.at(1);
  return block.parameters.at(static_cast<std::size_t>(block.type->parameter(name)));
}

Graph file_block(const std::string& parameters) {
  return good("bodeflow: 1\nblocks:\n  x: {block: acquisition.file, file: /d/a.csv, " + parameters + "}\n");
}

}  // namespace

TEST_CASE("graph: numbers are in the parameter's unit, exactly as the literal would be") {
  const auto frequency = [](const std::string& text) {
    return value(good("bodeflow: 1\nblocks: {s: {block: generators.sine, frequency: " + text + "}}"), "frequency");
  };
  CHECK(frequency("10 kHz").numbers == std::vector<double>{10e3});
  CHECK(frequency("2.5").numbers == std::vector<double>{2.5});
  CHECK(frequency("'1e-3 Hz'").numbers == std::vector<double>{1e-3});
  CHECK(frequency("0.1").numbers == std::vector<double>{0.1});
  CHECK(frequency("0").numbers == std::vector<double>{0.0});
  CHECK(frequency("10 kHz").type == BF_NUMBER);
  CHECK(frequency("10 kHz").rows == 1);
  CHECK(frequency("10 kHz").given);
}

TEST_CASE("graph: numbers of a block that tells their unit are in that unit") {
  const auto offset = [](const std::string& text, const std::string& more) {
    return second(with("filters.gain", "offset: " + text + more), "offset").numbers.at(0);
  };
  CHECK(offset("5 mV", "") == 5e-3);  // no unit is told: SI
  CHECK(offset("5 mV", ", unit: V") == 5e-3);
  CHECK(offset("5 mV", ", unit: mV") == 5.0);
  CHECK(offset("2 V", ", unit: mV") == 2000.0);
  CHECK(offset("5", ", unit: mV") == 5.0);
  CHECK(offset("100 rpm", ", unit: rpm") == 100.0);
  CHECK(offset("100 rpm", ", unit: mV") == Approx(10.4719755));  // another dimension: SI
  CHECK(offset("50 %", ", unit: mV") == 0.5);
  ParameterDescription live;
  live.type = BF_NUMBER;
  CHECK(read_live_value(live, "offset", "2 V", "mV").value().numbers == std::vector<double>{2000.0});
}

TEST_CASE("graph: defaults stand where nothing is written, at the block's place") {
  const Graph graph = good("bodeflow: 1\nblocks:\n  s: {block: generators.sine}\n");
  CHECK_FALSE(value(graph, "frequency").given);
  CHECK(value(graph, "frequency").numbers == std::vector<double>{1.0});
  const Block& block = graph.phases[0].blocks[0];
  CHECK(block.place.line == 3);
  CHECK(block.place.column == 3);
  CHECK(block.parameter_places.at(0).line == 3);
  CHECK(block.parameter_places.at(0).column == 3);
}

TEST_CASE("graph: a given parameter knows its place") {
  const Graph graph = good("bodeflow: 1\nblocks:\n  s:\n    block: generators.sine\n    frequency: 3 Hz\n");
  const Place& place = graph.phases[0].blocks[0].parameter_places.at(0);
  CHECK(place.file == "g.yaml");
  CHECK(place.line == 5);
  CHECK(place.column == 16);
}

TEST_CASE("graph: dotted parameters are nested maps, or written with the dot") {
  const std::string head = "bodeflow: 1\nblocks: {m: {block: generators.multisine, sample_rate: 1 kHz, period: 64, ";
  for (const char* lines : {"lines: {first: 3, last: 9}", "lines.first: 3, lines.last: 9", "lines.first: 3, lines: {last: 9}"}) {
    const Graph graph = good(head + lines + "}}");
    CHECK(value(graph, "lines.first").integer == 3);
    CHECK(value(graph, "lines.last").integer == 9);
    CHECK_FALSE(value(graph, "lines.step").given);
  }
}

TEST_CASE("graph: an alias of a parameter is accepted") {
  CHECK(second(with("filters.gain", "factor: 3"), "gain").numbers == std::vector<double>{3.0});
}

TEST_CASE("graph: choices, texts and booleans") {
  const Graph graph = good("bodeflow: 1\nblocks: {m: {block: generators.multisine, sample_rate: 1, period: 8, phases: random}}");
  CHECK(value(graph, "phases").strings == std::vector<std::string>{"random"});
  CHECK(value(file_block("header: false"), "header").integer == 0);
  CHECK(value(file_block("header: true"), "header").integer == 1);
  CHECK(value(file_block("note: no"), "note").strings == std::vector<std::string>{"no"});
  CHECK(value(file_block("note: 010"), "note").strings == std::vector<std::string>{"010"});
  CHECK(value(file_block("note: ''"), "note").strings == std::vector<std::string>{""});
  CHECK(value(file_block("note: \"\\u00b5 'x'\""), "note").strings == std::vector<std::string>{"\xC2\xB5 'x'"});
}

TEST_CASE("graph: lists, and single values in their place") {
  CHECK(value(file_block("columns: [a, 'b, c']"), "columns").strings == std::vector<std::string>{"a", "b, c"});
  CHECK(value(file_block("columns: a"), "columns").strings == std::vector<std::string>{"a"});
  CHECK(value(file_block("columns: a:b"), "columns").strings == std::vector<std::string>{"a:b"});
  CHECK(value(file_block("rows: [1, -2, +3]"), "rows").integers == std::vector<std::int64_t>{1, -2, 3});
  CHECK(value(file_block("rows: 4:7"), "rows").integers == std::vector<std::int64_t>{4, 7});
  CHECK(value(file_block("rows: []"), "rows").rows == 0);
  CHECK(value(file_block("rows: [5, 6]"), "rows").rows == 2);
  CHECK(second(with("plants.linear", "numerator: [1, 2e-3]"), "numerator").numbers == std::vector<double>{1.0, 2e-3});
  CHECK(second(with("plants.linear", "numerator: 0:0.625"), "numerator").numbers == std::vector<double>{0.0, 0.625});
}

TEST_CASE("graph: complex numbers are texts or pairs") {
  const Graph graph = with("plants.linear", "poles: [-2+3j, [-2, -3], 4, j, -1e-3-2.5e+1j, '1 - 2j', -i]");
  const ParameterValue& poles = second(graph, "poles");
  CHECK(poles.type == BF_COMPLEX_LIST);
  CHECK(poles.rows == 7);
  CHECK(poles.numbers == std::vector<double>{-2, 3, -2, -3, 4, 0, 0, 1, -1e-3, -25, 1, -2, 0, -1});
}

TEST_CASE("graph: a matrix is a list of rows") {
  const Graph graph = with("plants.linear", "A: [[1, 2, 3], [4, 5, 6]]");
  CHECK(second(graph, "A").rows == 2);
  CHECK(second(graph, "A").columns == 3);
  CHECK(second(graph, "A").numbers == std::vector<double>{1, 2, 3, 4, 5, 6});
  CHECK(second(with("plants.linear", "A: 7"), "A").numbers == std::vector<double>{7});
  CHECK(second(with("plants.linear", "A: 7"), "A").columns == 1);
}

TEST_CASE("graph: the limits of a range are allowed unless they are exclusive") {
  CHECK(second(with("plants.linear", "delay: 10 s"), "delay").numbers == std::vector<double>{10.0});
  CHECK(second(with("plants.linear", "delay: 0"), "delay").numbers == std::vector<double>{0.0});
  CHECK(problems("bodeflow: 1\nblocks: {m: {block: generators.multisine, sample_rate: 0, period: 8}}") ==
        "g.yaml:2:56: block 'm': parameter 'sample_rate': found '0', allowed: above 0 Hz");
}

TEST_CASE("graph: anchors and aliases repeat values") {
  const Graph graph = good(
      "bodeflow: 1\nblocks:\n  a: {block: generators.sine, frequency: &f 3 Hz}\n  b: {block: generators.sine, frequency: *f}\n"
      "  c: &c {block: generators.sine, frequency: 5 Hz}\n  d: *c\n");
  const auto frequency = [&](std::size_t i) { return graph.phases[0].blocks.at(i).parameters.at(0).numbers.at(0); };
  CHECK(frequency(1) == 3.0);
  CHECK(frequency(3) == 5.0);
}

}  // namespace bodeflow::graph
