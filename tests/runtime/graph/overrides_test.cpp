#include <filesystem>

#include "catch.hpp"
#include "registry.hpp"

namespace bodeflow::graph {
namespace {

const std::string kGraph =
    "bodeflow: 1\nvariables: {rate: 1 kHz, data: , lines: {first: 2, last: 5}}\nblocks:\n"
    "  m: {block: generators.multisine, sample_rate: \"${rate}\", period: 64, lines: \"${lines}\"}\n"
    "  f: {block: acquisition.file, file: \"${data}\", note: \"at ${rate}\"}\n";

LoadOptions set(std::vector<std::pair<std::string, std::string>> overrides) { return {std::move(overrides), {}}; }

const ParameterValue& value(const Graph& graph, const std::string& block, const std::string& parameter, std::size_t phase = 0) {
  const Phase& p = graph.phases.at(phase);
  const Block& b = p.blocks.at(static_cast<std::size_t>(p.block_index(block)));
  return b.parameters.at(static_cast<std::size_t>(b.type->parameter(parameter)));
}

const std::string kPhases =
    "bodeflow: 1\nphases:\n  - {name: one, run: {seed: 5}, blocks: {s: {block: generators.sine}}}\n"
    "  - {name: two, blocks: {s: {block: generators.sine}}}\n";

}  // namespace

TEST_CASE("graph: variables stand for values, lists and maps, alone and inside a text") {
  const Graph graph = good(kGraph, set({{"data", "/d/x.csv"}}));
  CHECK(value(graph, "m", "sample_rate").numbers[0] == 1000.0);
  CHECK(value(graph, "m", "lines.first").integer == 2);
  CHECK(value(graph, "f", "note").strings[0] == "at 1 kHz");
  CHECK(value(graph, "f", "file").strings[0] == "/d/x.csv");
}

TEST_CASE("graph: variables may use each other, and $${ is the text ${") {
  const Graph graph = good(
      "bodeflow: 1\nvariables: {a: \"${b}-${b}\", b: \"${c}\", c: x}\nblocks: {s: {block: generators.sine}}\ntitle: ${a} $${a} "
      "$5\n");
  CHECK(graph.title == "x-x ${a} $5");
}

TEST_CASE("graph: --set gives a variable, a part of one, a parameter or a setting") {
  const Graph graph = good(kGraph, set({{"data", "/d/x.csv"},
                                        {"rate", "2 kHz"},
                                        {"lines.last", "9"},
                                        {"m.amplitude", "3 V"},
                                        {"blocks.m.lines.step", "2"},
                                        {"run.duration", "4 s"},
                                        {"title", "a: b"},
                                        {"f.columns", "[u, 'y, z']"},
                                        {"record", "all"}}));
  CHECK(value(graph, "m", "sample_rate").numbers[0] == 2000.0);
  CHECK(value(graph, "m", "lines.first").integer == 2);
  CHECK(value(graph, "m", "lines.last").integer == 9);
  CHECK(value(graph, "m", "lines.step").integer == 2);
  CHECK(value(graph, "m", "amplitude").numbers[0] == 3.0);
  CHECK(value(graph, "f", "columns").strings == std::vector<std::string>{"u", "y, z"});
  CHECK(graph.phases[0].run.duration_s == 4.0);
  CHECK(graph.title == "a: b");
  CHECK(graph.phases[0].recorded.size() == 2);
}

TEST_CASE("graph: of several --set the last one holds") {
  CHECK(value(good(kGraph, set({{"data", "/a"}, {"data", "/b"}})), "f", "file").strings[0] == "/b");
  CHECK(value(good(kGraph, set({{"data", "/a"}, {"m.period", "8"}, {"m.period", "16"}})), "m", "period").integer == 16);
}

TEST_CASE("graph: --set wins over an alias, and over another spelling of a nested name") {
  const std::string text =
      "bodeflow: 1\nblocks:\n  s: {block: generators.multisine, sample_rate: 1, period: 8, lines.first: 2}\n  g: {block: "
      "filters.gain, factor: 2}\n"
      "connections: [s -> g]\n";
  const Graph graph = good(text, set({{"g.gain", "5"}, {"s.lines.first", "3"}}));
  CHECK(value(graph, "g", "gain").numbers[0] == 5.0);
  CHECK(value(graph, "s", "lines.first").integer == 3);
  CHECK(good(graph.expanded).expanded == graph.expanded);
}

TEST_CASE("graph: a path of the file is relative to the file, one of --set to the working directory") {
  const std::string text =
      "bodeflow: 1\nvariables: {folder: data}\nblocks:\n  a: {block: acquisition.file, file: x.csv}\n"
      "  b: {block: acquisition.file, file: \"${folder}/../y.csv\"}\n";
  const auto load_at = [&](const LoadOptions& options) {
    const auto graph = load_text(text, "/graphs/here/g.yaml", options, test_registry());
    REQUIRE(graph);
    return *graph;
  };
  const std::string here = std::filesystem::current_path().string();
  CHECK(value(load_at({}), "a", "file").strings[0] == "/graphs/here/x.csv");
  CHECK(value(load_at({}), "b", "file").strings[0] == "/graphs/here/y.csv");
  CHECK(value(load_at(set({{"a.file", "z.csv"}})), "a", "file").strings[0] == here + "/z.csv");
  CHECK(value(load_at(set({{"folder", "../q"}})), "b", "file").strings[0] ==
        (std::filesystem::path(here) / "../y.csv").lexically_normal().string());
  CHECK(load_at({}).expanded.find("file: /graphs/here/y.csv") != std::string::npos);
}

TEST_CASE("graph: --set reaches a block in all phases, or in one") {
  const Graph all = good(kPhases, set({{"s.frequency", "3"}}));
  CHECK(value(all, "s", "frequency", 0).numbers[0] == 3.0);
  CHECK(value(all, "s", "frequency", 1).numbers[0] == 3.0);
  for (const char* path :
       {"two.s.frequency", "phases.two.s.frequency", "phases.two.blocks.s.frequency", "two.blocks.s.frequency"}) {
    const Graph one = good(kPhases, set({{path, "3"}}));
    CHECK(value(one, "s", "frequency", 0).numbers[0] == 1.0);
    CHECK(value(one, "s", "frequency", 1).numbers[0] == 3.0);
  }
  CHECK(good(kPhases, set({{"two.run.seed", "9"}})).phases[1].run.seed == 9);
}

TEST_CASE("graph: --seed is the seed of the run and of every phase") {
  LoadOptions options;
  options.seed = 18446744073709551615u;
  const Graph graph = good(kPhases, options);
  CHECK(graph.phases[0].run.seed == *options.seed);
  CHECK(graph.phases[1].run.seed == *options.seed);
  CHECK(good(graph.expanded).phases[0].run.seed == *options.seed);
}

TEST_CASE("graph: wrong --set are refused with their exact message") {
  const std::string missing = "g.yaml:2:26: variable 'data' has no value: give one with --set data=VALUE";
  const auto refused = [](const std::string& path, const std::string& text) {
    return problems(kGraph, set({{"data", "/d"}, {path, text}}));
  };
  CHECK(problems(kGraph) == missing);
  CHECK(problems(kGraph, set({{"data", ""}})) == missing);
  CHECK(refused("rat", "1") == "--set rat=1: 'rat' is no variable, block, phase or key of the graph (did you mean 'rate'?)");
  CHECK(refused("lines.first.x", "1") == "--set lines.first.x=1: 'lines.first' is '2', there is nothing below it");
  CHECK(refused("m.perod", "8") == "--set m.perod=8: block 'm': unknown parameter 'perod' (did you mean 'period'?)");
  CHECK(refused("m.period", "x") == "--set m.period=x: block 'm': parameter 'period': found 'x', allowed: a whole number");
  CHECK(refused("blocks.n.period", "8") == "--set blocks.n.period=8: unknown block 'n'; blocks: m, f");
  CHECK(refused("run.sed", "8") == "--set run.sed=8: run: unknown key 'sed' (did you mean 'seed'?)");
  CHECK(refused("m..period", "8") == "--set m..period=8: 'm..period' is not a path: words with dots between them");
  CHECK(refused("rate", "3 V") ==
        "--set rate=3 V: block 'm': parameter 'sample_rate': 3 V is a voltage; allowed: a frequency in Hz");
  CHECK(refused("f.columns", "[a").find("--set f.columns=[a: not valid YAML: ']' or ',' is missing") == 0);
  CHECK(refused("f.note", "\xFF") == "--set ?: not UTF-8");
  CHECK(problems(kPhases, set({{"phases.tow.s.frequency", "3"}})) ==
        "--set phases.tow.s.frequency=3: 'tow' is no variable, block, phase or key of the graph (did you mean 'two'?)");
}

}  // namespace bodeflow::graph
