// Compute threads of a realtime run take no memory from the heap: blocks that say they are real-time safe, and the engine around
// them. A thread is a compute thread from the first samples on that it hands to the sink.
#include <atomic>
#include <cstdlib>
#include <thread>

#include "catch.hpp"
#include "execute/execute.hpp"
#include "graph/load.hpp"
#include "phases/prepare.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

std::atomic<bool> counting{false};
std::atomic<long> allocations{0};
thread_local bool is_compute = false;

void count() {
  if (counting.load(std::memory_order_relaxed) && is_compute) allocations.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* memory, std::size_t size) {
  count();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  count();
  return __libc_memalign(alignment, size);
}
}

namespace bodeflow::test {
namespace {

class NoSink final : public execute::Sink {
 public:
  tl::expected<void, std::string> samples(int, const void* const*, std::uint64_t) override {
    is_compute = true;
    if (allocates) std::free(std::malloc(static_cast<std::size_t>(++taken)));
    return {};
  }
  tl::expected<void, std::string> record(graph::End, const SharedRecord&, double) override { return {}; }
  void changed(int, int, const ParameterValue&, std::uint64_t) override {}

  bool allocates = false;
  int taken = 0;
};

constexpr const char* kGraph =
    "bodeflow: 1\n"
    "run: {clock: realtime, duration: 300 ms, chunk: 1, on_overrun: skip, priority: 10}\n"
    "blocks:\n"
    "  reference: {block: generators.sine, sample_rate: 1 kHz, frequency: 7 Hz}\n"
    "  noise: {block: generators.noise, sample_rate: 1 kHz, std: 0.1}\n"
    "  sum: {block: filters.sum, weights: [1, 1, -1]}\n"
    "  smooth: {block: filters.fir, taps: 31, edges: 100 Hz}\n"
    "  plant: {block: plants.linear, numerator: [1], denominator: [1, 0.05]}\n"
    "  back: {block: filters.delay, samples: 1}\n"
    "  gain: {block: filters.gain, gain: 2}\n"
    "connections:\n"
    "  - reference -> sum.a\n"
    "  - noise -> sum.b\n"
    "  - sum -> plant -> back -> sum.c\n"
    "  - plant -> smooth -> gain\n"
    "record: all\n";

struct Counted {
  execute::Outcome outcome;
  long allocations = 0;
};

Counted run(int threads, bool allocating_sink) {
  Registry registry{{{BODEFLOW_PLUGINS}, {}, BODEFLOW_PROBE_HELPER}};
  const auto graph = graph::load_text(kGraph, "graph.yaml", {}, registry);
  if (!graph) FAIL(to_string(graph.error()));
  const graph::Phase& phase = graph->phases[0];
  for (const auto& block : phase.blocks) {
    INFO(block.type->id);
    REQUIRE(block.type->realtime_safe);
  }
  phases::PlanSettings settings;
  settings.threads = threads;
  const auto prepared = phases::prepare(phase, registry, std::make_shared<HostServices>(), settings);
  if (!prepared) FAIL(to_string(prepared.error()));
  NoSink sink;
  sink.allocates = allocating_sink;
  execute::Options options;
  options.clock = phase.run.clock;
  Counted counted;
  allocations = 0;
  counting = true;
  counted.outcome = execute::execute(phase, prepared->facts, prepared->plan, prepared->instances, {}, sink, options);
  counting = false;
  counted.allocations = allocations;
  return counted;
}

TEST_CASE("compute threads of a realtime run allocate nothing") {
  for (const int threads : {1, 2}) {
    const Counted counted = run(threads, false);
    INFO(counted.outcome.reason);
    REQUIRE(counted.outcome.status == execute::Outcome::Status::complete);
    CHECK(counted.outcome.lateness.chunks >= 299);
    CHECK(counted.allocations == 0);
  }
}

TEST_CASE("the count of allocations sees a compute thread that allocates") {
  const Counted counted = run(1, true);
  REQUIRE(counted.outcome.status == execute::Outcome::Status::complete);
  CHECK(counted.allocations >= 299);
}

}  // namespace
}  // namespace bodeflow::test

#endif
