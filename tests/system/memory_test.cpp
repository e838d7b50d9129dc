// The bytes that a run really takes for its buffers and rings, counted in place of the C library, against the plan's figure.

#include <fmt/format.h>
#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "catch.hpp"
#include "execute/execute.hpp"
#include "graph/load.hpp"
#include "phases/prepare.hpp"

namespace {

std::atomic<bool> armed{false};
std::atomic<std::uint64_t> counted{0};

}  // namespace

/// Buffers come from here.
extern "C" void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  if (armed) counted += size;
  return memalign(alignment, size);
}

/// Objects with an alignment of their own are no buffers.
void* operator new(std::size_t size, std::align_val_t alignment) {
  if (void* memory = memalign(static_cast<std::size_t>(alignment), size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace {

using namespace bodeflow;

class Nothing final : public execute::Sink {
 public:
  tl::expected<void, std::string> samples(int, const void* const*, std::uint64_t) override { return {}; }
  tl::expected<void, std::string> record(graph::End, const SharedRecord&, double) override { return {}; }
  void changed(int, int, const ParameterValue&, std::uint64_t, execute::Cause) override {}
};

/// 500 blocks in chains of ten, with a decimator, a delay and a loop here and there.
std::string five_hundred_blocks() {
  std::string text = "bodeflow: 1\nrun: {duration: 50 ms}\nblocks:\n", connections = "connections:\n";
  for (int chain = 0; chain < 50; ++chain) {
    text += fmt::format("  s{0}: {{block: generators.sine, sample_rate: 100 kHz, frequency: {1} Hz}}\n", chain, 10 * (chain + 1));
    connections += fmt::format("  - s{0}", chain);
    for (int b = 0; b < 9; ++b) {
      if (b == 4 && chain % 3 == 0)
        text += fmt::format("  b{}_{}: {{block: filters.delay, samples: 17}}\n", chain, b);
      else if (b == 5 && chain % 5 == 0)
        text += fmt::format("  b{}_{}: {{block: filters.decimate, factor: 4, anti_alias: false}}\n", chain, b);
      else
        text += fmt::format("  b{}_{}: {{block: filters.gain, gain: {}}}\n", chain, b, 1.0 + 0.01 * b);
      connections += fmt::format(" -> b{}_{}", chain, b);
    }
    connections += "\n";
  }
  return text + connections;
}

void require_planned_bytes(int threads) {
  Registry registry({{BODEFLOW_BUILD_DIR "/plugins"}, {}, BODEFLOW_BUILD_DIR "/bin/bodeflow"});
  auto graph = graph::load_text(five_hundred_blocks(), "blocks.yaml", {}, registry);
  if (!graph) FAIL(to_string(graph.error()));
  phases::PlanSettings settings;
  settings.threads = threads;
  auto prepared = phases::prepare(graph->phases[0], registry, std::make_shared<HostServices>(), settings);
  if (!prepared) FAIL(to_string(prepared.error()));

  Nothing sink;
  counted = 0;
  armed = true;
  const auto outcome = execute::execute(graph->phases[0], prepared->facts, prepared->plan, prepared->instances, {}, sink, {});
  armed = false;
  INFO(outcome.reason);
  REQUIRE(outcome.status == execute::Outcome::Status::complete);
  INFO("threads " << prepared->plan.partitions.size() << ", counted " << counted << ", planned " << prepared->plan.bytes);
  CHECK(static_cast<double>(counted) == Approx(static_cast<double>(prepared->plan.bytes)).epsilon(0.1));
}

}  // namespace

TEST_CASE("the bytes of buffers that a 500-block run takes are those of its plan, on one thread") { require_planned_bytes(1); }
TEST_CASE("the bytes of buffers and rings that a 500-block run takes are those of its plan, on four threads") {
  require_planned_bytes(4);
}
