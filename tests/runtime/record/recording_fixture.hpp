#pragma once

#include <bodeflow/record.hpp>
#include <complex>
#include <string>
#include <vector>

#include "record/run_directory.hpp"
#include "temporary_folder.hpp"

namespace bodeflow::record_tests {

/// A block with a real and a complex stream, two message outputs, and live parameters.
inline const BlockDescription& source_type() {
  static const BlockDescription type = [] {
    BlockDescription d;
    d.id = "test.source";
    const auto port = [&](std::uint32_t kind, std::uint32_t element, const char* name, int index) {
      PortDescription p;
      p.kind = kind;
      p.direction = BF_OUT;
      p.element = element;
      p.name = name;
      p.index = index;
      d.ports.push_back(p);
    };
    port(BF_STREAM, BF_F64, "real", 0);
    port(BF_STREAM, BF_C64, "complex", 1);
    port(BF_MESSAGE, BF_ANY, "model", 0);
    port(BF_MESSAGE, BF_ANY, "trace", 1);
    for (const char* name : {"gain", "poles"}) {
      ParameterDescription p;
      p.name = name;
      p.live = true;
      d.parameters.push_back(p);
    }
    return d;
  }();
  return type;
}

/// A phase with the one block `source`; both streams are recorded.
inline graph::Phase source_phase(const std::string& name = "") {
  graph::Phase phase;
  phase.name = name;
  graph::Block block;
  block.name = "source";
  block.type = &source_type();
  phase.blocks.push_back(block);
  phase.recorded = {{{0, 0}, BF_STREAM}, {{0, 1}, BF_STREAM}, {{0, 0}, BF_MESSAGE}};
  return phase;
}

inline graph::Graph source_graph(std::vector<graph::Phase> phases) {
  graph::Graph graph;
  graph.file = "source.yaml";
  graph.title = "A source";
  graph.phases = std::move(phases);
  graph.expanded = "bodeflow: 1\n";
  return graph;
}

/// Two real channels at 1 kHz in volt and ampere, one complex channel.
inline plan::Facts source_facts() {
  plan::Facts facts;
  plan::Facts::Block block;
  StreamFacts real;
  real.known = true;
  real.element = BF_F64;
  real.channels = 2;
  real.rate = Rate(1000, 1);
  real.clock = "bench";
  real.channel_names = {"voltage", "current"};
  real.channel_units = {"V", "A"};
  StreamFacts complex = real;
  complex.element = BF_C64;
  complex.channels = 1;
  complex.rate = Rate(1000, 3);
  complex.unit = "rad/A";
  complex.channel_names.clear();
  complex.channel_units.clear();
  block.outputs = {real, complex};
  facts.blocks.push_back(block);
  return facts;
}

inline double real_value(std::uint64_t n, int channel) {
  return channel == 0 ? 0.1 * static_cast<double>(n) : -static_cast<double>(n);
}

/// Gives samples first .. first + count of the real stream.
inline tl::expected<void, std::string> give_real(execute::Sink& sink, std::uint64_t first, std::uint64_t count) {
  std::vector<double> voltage(count), current(count);
  for (std::uint64_t n = 0; n < count; ++n) {
    voltage[n] = real_value(first + n, 0);
    current[n] = real_value(first + n, 1);
  }
  const void* channels[] = {voltage.data(), current.data()};
  return sink.samples(0, channels, count);
}

inline std::complex<double> complex_value(std::uint64_t n) { return {static_cast<double>(n), -0.5 * static_cast<double>(n)}; }

inline tl::expected<void, std::string> give_complex(execute::Sink& sink, std::uint64_t first, std::uint64_t count) {
  std::vector<std::complex<double>> values(count);
  for (std::uint64_t n = 0; n < count; ++n) values[n] = complex_value(first + n);
  const void* channels[] = {values.data()};
  return sink.samples(1, channels, count);
}

inline SharedRecord finished(const RecordBuilder& builder) {
  const auto bytes = builder.bytes();
  return SharedRecord::copy(bytes.data(), bytes.size());
}

/// A record that tells its number.
inline SharedRecord numbered_record(std::int64_t number) {
  RecordBuilder r("model");
  r.set("number", number);
  const auto out = r.array<double>("parameters", "1", {3});
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<double>(number) + 0.25 * static_cast<double>(i);
  return finished(r);
}

inline std::int64_t number_of(const SharedRecord& record) { return RecordView(record.bytes()).integer("number").value(); }

/// A run directory `run` in `folder`; the test fails if it can't be made.
inline std::unique_ptr<record::RunDirectory> make_run(const fs::path& folder, const graph::Graph& graph) {
  record::RunDirectory::Options options;
  options.directory = folder / "run";
  options.graph_name = "source";
  options.manifest = {{"seed", 7}, {"isa", "avx2"}, {"status", "not ours"}};
  auto run = record::RunDirectory::create(options, graph);
  if (!run) throw std::runtime_error(run.error());
  return std::move(*run);
}

inline nlohmann::ordered_json read_json(const fs::path& file) {
  FILE* stream = std::fopen(file.c_str(), "rb");
  if (stream == nullptr) throw std::runtime_error("no " + file.string());
  const auto json = nlohmann::ordered_json::parse(stream);
  std::fclose(stream);
  return json;
}

}  // namespace bodeflow::record_tests
