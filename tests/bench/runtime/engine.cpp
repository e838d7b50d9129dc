#include "engine.hpp"

#include <fmt/format.h>

#include <bodeflow/record.hpp>
#include <stdexcept>

#include "execute/execute.hpp"
#include "graph/load.hpp"
#include "phases/prepare.hpp"

namespace bench {
namespace {

using namespace bodeflow;

/// Keeps the last record, nothing else.
class LastRecord final : public execute::Sink {
 public:
  tl::expected<void, std::string> samples(int, const void* const*, std::uint64_t) override { return {}; }
  tl::expected<void, std::string> record(graph::End, const SharedRecord& record, double) override {
    last = record;
    return {};
  }
  void changed(int, int, const ParameterValue&, std::uint64_t, execute::Cause) override {}

  SharedRecord last;
};

std::string seconds_of(std::size_t samples) { return fmt::format("{} s", static_cast<double>(samples) / 1e6); }

}  // namespace

struct Engine::State {
  Registry registry{{{BENCH_PLUGINS, BODEFLOW_PLUGINS}, {}, BODEFLOW_COMMAND}};
  graph::Graph graph;
  phases::Prepared prepared;
  execute::Options options;
  LastRecord sink;
};

Engine::Engine(const std::string& yaml, const EngineOptions& options) : state_(new State) {
  auto graph = graph::load_text(yaml, "benchmark.yaml", {}, state_->registry);
  if (!graph) throw std::runtime_error(to_string(graph.error()));
  state_->graph = std::move(*graph);
  phases::PlanSettings settings;
  settings.threads = options.threads;
  settings.chunk = options.chunk;
  auto prepared = phases::prepare(state_->graph.phases[0], state_->registry, std::make_shared<HostServices>(), settings);
  if (!prepared) throw std::runtime_error(to_string(prepared.error()));
  state_->prepared = std::move(*prepared);
  state_->options.metrics = options.metrics;
  state_->options.vector_level = __builtin_cpu_supports("avx512f") ? 4 : __builtin_cpu_supports("avx2") ? 3 : 1;
}

Engine::~Engine() { delete state_; }

void Engine::run() {
  const auto outcome = execute::execute(state_->graph.phases[0], state_->prepared.facts, state_->prepared.plan,
                                        state_->prepared.instances, {}, state_->sink, state_->options);
  if (outcome.status != execute::Outcome::Status::complete) throw std::runtime_error(outcome.reason);
}

std::vector<double> Engine::ages() const {
  const auto record = RecordView::check({state_->sink.last.bytes(), state_->sink.last.size()});
  const auto ages = record->array("age")->as<double>();
  return {ages.begin(), ages.end()};
}

std::string multiply_graph(int blocks, std::size_t samples) {
  std::string text = fmt::format(
      "bodeflow: 1\nrun: {{duration: {}}}\nblocks:\n  source: {{block: bench.source}}\n  sink: {{block: bench.sink}}\n",
      seconds_of(samples));
  std::string chain = "source";
  for (int b = 0; b < blocks; ++b) {
    text += fmt::format("  g{}: {{block: filters.gain, gain: {}}}\n", b, 1.0 + 1e-3 * (b + 1));
    chain += fmt::format(" -> g{}", b);
  }
  return text + "connections:\n  - " + chain + " -> sink\n";
}

std::string feedback_graph(std::size_t samples) {
  return fmt::format(
      "bodeflow: 1\nrun: {{duration: {}}}\nblocks:\n  source: {{block: bench.source}}\n  sum: {{block: filters.sum}}\n"
      "  gain: {{block: filters.gain, gain: 0.5}}\n  delay: {{block: filters.delay, samples: 1}}\n  sink: {{block: bench.sink}}\n"
      "connections:\n  - source -> sum.a\n  - sum -> gain -> delay -> sum.b\n  - gain -> sink\n",
      seconds_of(samples));
}

std::string latency_graph(std::size_t samples) {
  std::string text = fmt::format(
      "bodeflow: 1\nrun: {{duration: {}}}\nblocks:\n  stamp: {{block: bench.stamp}}\n  age: {{block: bench.age, samples: {}}}\n",
      seconds_of(samples), samples);
  std::string chain = "stamp";
  for (int b = 0; b < 8; ++b) {
    text += fmt::format("  c{}: {{block: bench.copy}}\n", b);
    chain += fmt::format(" -> c{}", b);
  }
  return text + "connections:\n  - " + chain + " -> age\n";
}

std::string heavy_graph(std::size_t samples) {
  return fmt::format(
      "bodeflow: 1\nrun: {{duration: {}}}\nblocks:\n  source: {{block: bench.source}}\n  a: {{block: bench.heavy}}\n  b: "
      "{{block: bench.heavy}}\n"
      "  sink: {{block: bench.sink}}\nconnections:\n  - source -> a -> b -> sink\n",
      seconds_of(samples));
}

}  // namespace bench
