#include <nlohmann/json.hpp>

#include "catch.hpp"
#include "system/command.hpp"

using bodeflow::test::Folder;
using bodeflow::test::run_bodeflow;
using Catch::Matchers::Contains;

namespace {

constexpr const char* kChain =
    "bodeflow: 1\n"
    "title: A chain\n"
    "run: {duration: 10 ms}\n"
    "blocks:\n"
    "  tone: {block: generators.sine, sample_rate: 10 kHz, frequency: 100 Hz}\n"
    "  twice: {block: filters.gain, gain: 2}\n"
    "  table: {block: output.csv, file: tone.csv}\n"
    "connections:\n"
    "  - tone -> twice -> table\n";

}  // namespace

TEST_CASE("a word that is no command is a usage error that lists what there is") {
  const auto ended = run_bodeflow({"frobnicate"});
  CHECK(ended.exit_code == 2);
  CHECK(ended.out.empty());
}

TEST_CASE("check accepts a right graph and tells how big it is") {
  const Folder folder;
  folder.write("chain.yaml", kChain);
  const auto ended = run_bodeflow({"check", "chain.yaml"}, folder.path());
  CHECK(ended.exit_code == 0);
  CHECK(ended.out == "chain.yaml: 3 blocks, 2 connections, right\n");
}

TEST_CASE("check tells all problems at once, each with its place, and exits with 3") {
  const Folder folder;
  folder.write("wrong.yaml",
               "bodeflow: 1\n"
               "run: {duration: 10 ms}\n"
               "blocks:\n"
               "  tone: {block: generators.sin, sample_rate: 10 kHz}\n"
               "  twice: {block: filters.gain, gian: 2}\n"
               "connections:\n"
               "  - tone -> twise\n");
  const auto ended = run_bodeflow({"check", "wrong.yaml"}, folder.path());
  CHECK(ended.exit_code == 3);
  CHECK_THAT(ended.err, Contains("wrong.yaml:4:") && Contains("did you mean 'generators.sine'?"));
  CHECK_THAT(ended.err, Contains("wrong.yaml:5:") && Contains("did you mean 'gain'?"));
  CHECK_THAT(ended.err, Contains("wrong.yaml:7:") && Contains("did you mean 'twice'?"));
}

TEST_CASE("a graph file that is not there is named, with exit code 3") {
  const Folder folder;
  const auto ended = run_bodeflow({"run", "absent.yaml"}, folder.path());
  CHECK(ended.exit_code == 3);
  CHECK_THAT(ended.err, Contains("absent.yaml"));
}

TEST_CASE("plan prints the calls in order, the chunk and the memory, and the same as JSON") {
  const Folder folder;
  folder.write("chain.yaml", kChain);
  const auto text = run_bodeflow({"plan", "chain.yaml"}, folder.path());
  CHECK(text.exit_code == 0);
  CHECK(text.out.find("tone") < text.out.find("twice"));
  CHECK(text.out.find("twice") < text.out.find("table"));
  const auto json = run_bodeflow({"plan", "chain.yaml", "--json"}, folder.path());
  CHECK(json.exit_code == 0);
  CHECK(nlohmann::json::parse(json.out).is_array());
  CHECK(run_bodeflow({"plan", "chain.yaml", "--json"}, folder.path()).out == json.out);
}

TEST_CASE("graph draws dot and mermaid with every block and edge") {
  const Folder folder;
  folder.write("chain.yaml", kChain);
  const auto dot = run_bodeflow({"graph", "chain.yaml", "--format", "dot"}, folder.path());
  CHECK(dot.exit_code == 0);
  CHECK_THAT(dot.out, Contains("digraph") && Contains("generators.sine") && Contains("p0b0 -> p0b1") && Contains("p0b1 -> p0b2"));
  const auto mermaid = run_bodeflow({"graph", "chain.yaml", "--format", "mermaid"}, folder.path());
  CHECK(mermaid.exit_code == 0);
  CHECK_THAT(mermaid.out, Contains("flowchart LR") && Contains("p0b0 --> p0b1"));
}

TEST_CASE("expand prints one file that runs to the same plan") {
  const Folder folder;
  folder.write("chain.yaml", kChain);
  const auto expanded = run_bodeflow({"expand", "chain.yaml", "--set", "twice.gain=3"}, folder.path());
  REQUIRE(expanded.exit_code == 0);
  CHECK_THAT(expanded.out, Contains("gain: 3"));
  folder.write("expanded.yaml", expanded.out);
  CHECK(run_bodeflow({"plan", "expanded.yaml", "--json"}, folder.path()).out ==
        run_bodeflow({"plan", "chain.yaml", "--json"}, folder.path()).out);
}

TEST_CASE("plugins lists the families, describe tells a block's ports and parameters, and names the nearest for a wrong id") {
  const auto list = run_bodeflow({"plugins"});
  CHECK(list.exit_code == 0);
  CHECK_THAT(list.out, Contains("spectrum.averaging_dft") && Contains("plants.linear") && Contains("acquisition.file"));
  const auto block = run_bodeflow({"describe", "filters.gain"});
  CHECK(block.exit_code == 0);
  CHECK_THAT(block.out, Contains("gain") && Contains("live") && Contains("Ports"));
  const auto wrong = run_bodeflow({"describe", "filters.gian"});
  CHECK(wrong.exit_code == 2);
  CHECK_THAT(wrong.err, Contains("did you mean 'filters.gain'?"));
}

TEST_CASE("schema is JSON that knows every block") {
  const auto ended = run_bodeflow({"schema"});
  REQUIRE(ended.exit_code == 0);
  CHECK(nlohmann::json::parse(ended.out).is_object());
  CHECK_THAT(ended.out, Contains("spectrum.averaging_dft") && Contains("sample_rate"));
}

TEST_CASE("doctor and the completion scripts work in every shell's form") {
  CHECK_THAT(run_bodeflow({"doctor"}).out, Contains("plugins") && Contains("processor"));
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const auto ended = run_bodeflow({"completion", shell});
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.out, Contains("test-plugin") && Contains("rerun"));
  }
  CHECK(run_bodeflow({"completion", "csh"}).exit_code == 2);
}

TEST_CASE("the bash completion is a script that bash accepts and that completes commands") {
  const Folder folder;
  folder.write("completion", run_bodeflow({"completion", "bash"}).out);
  const auto ended = bodeflow::test::run_program(
      {"bash", "-c", "source completion; COMP_WORDS=(bodeflow rer); COMP_CWORD=1; _bodeflow; echo ${COMPREPLY[@]}"},
      folder.path());
  CHECK(ended.exit_code == 0);
  CHECK(ended.out == "rerun\n");
}

TEST_CASE("bytes in a data file that are no UTF-8 spoil neither the JSON nor the terminal") {
  const Folder folder;
  folder.write("data.csv", "t [s],y\n0,1\n0.1,a\xff\n");
  folder.write("graph.yaml",
               "bodeflow: 1\nblocks:\n  in: {block: acquisition.file, file: data.csv}\n  out: {block: output.csv, file: o.csv}\n"
               "connections: [in.out -> out.in]\n");
  const auto ended = run_bodeflow({"check", "graph.yaml", "--json"}, folder.path());
  CHECK(ended.exit_code == 3);
  const auto printed = nlohmann::json::parse(ended.out);
  REQUIRE(printed["problems"].size() == 1);
  CHECK(printed["problems"][0]["text"].get<std::string>().find("is not a number") != std::string::npos);
  CHECK(ended.err.find('\xff') == std::string::npos);
}
