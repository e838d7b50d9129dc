// The engine beside GNU Radio and hand-written loops, interleaved in one run. Prints medians; the figures in
// tests/bench/README.md come from here.

#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "engine.hpp"
#include "hand.hpp"
#include "interleave.hpp"
#include "measure.hpp"
#include "radio.hpp"

namespace {

using bench::Candidate;
using bench::interleave;
using bench::print;

Candidate engine(const std::string& name, const std::string& graph, const bench::EngineOptions& options) {
  auto made = std::make_shared<bench::Engine>(graph, options);
  return {name, [made] { made->run(); }, {}, {}};
}

void multiply(int blocks, int repeats) {
  constexpr std::size_t kSamples = 20'000'000;
  const std::string graph = bench::multiply_graph(blocks, kSamples);
  std::vector<Candidate> candidates;
  candidates.push_back(engine("bodeflow", graph, {1, 1024, false}));
  candidates.push_back(engine("bodeflow, metrics on", graph, {1, 1024, true}));
  candidates.push_back({"GNU Radio, defaults", [=] { bench::radio_multiply(blocks, kSamples, false); }, {}, {}});
  candidates.push_back({"GNU Radio, at most 256 items", [=] { bench::radio_multiply(blocks, kSamples, true); }, {}, {}});
  candidates.push_back({"hand-written loop", [=] { bench::hand_multiply(blocks, kSamples); }, {}, {}});
  interleave(candidates, kSamples, repeats);
  print(fmt::format("{} multiply blocks", blocks), candidates);
}

void feedback(int repeats) {
  constexpr std::size_t kSamples = 10'000'000;
  std::vector<Candidate> candidates;
  candidates.push_back(engine("bodeflow", bench::feedback_graph(kSamples), {1, 1024, false}));
  candidates.push_back({"hand-written loop", [] { bench::hand_feedback(kSamples); }, {}, {}});
  interleave(candidates, kSamples, repeats);
  print("Feedback loop of 3 blocks, one sample of delay (GNU Radio refuses loops)", candidates);
  fmt::print("\n{:.1f} million samples/s\n", 1e3 / bench::median(candidates.front().wall_ns));
}

void heavy(int repeats) {
  constexpr std::size_t kSamples = 200'000;
  const std::string graph = bench::heavy_graph(kSamples);
  std::vector<Candidate> candidates;
  candidates.push_back(engine("bodeflow, 1 thread", graph, {1, 1024, false}));
  candidates.push_back(engine("bodeflow, 2 threads", graph, {2, 1024, false}));
  interleave(candidates, kSamples, repeats);
  print("Two heavy blocks", candidates);
  fmt::print("\nwall time of 1 thread over 2: {:.2f}\n",
             bench::median(candidates[0].wall_ns) / bench::median(candidates[1].wall_ns));
}

void latency(int repeats) {
  constexpr std::size_t kSamples = 20'000;
  bench::Engine engine(bench::latency_graph(kSamples), {1, 1, false});
  std::vector<double> p50[4], p99[4];
  const auto keep = [&](int row, const std::vector<double>& ages) {
    p50[row].push_back(bench::quantile(ages, 0.5));
    p99[row].push_back(bench::quantile(ages, 0.99));
  };
  for (int repeat = 0; repeat < repeats; ++repeat) {
    engine.run();
    keep(0, engine.ages());
    keep(1, bench::radio_latency(kSamples, false));
    keep(2, bench::radio_latency(kSamples, true));
    keep(3, bench::hand_latency(kSamples));
  }
  static constexpr const char* kNames[] = {"bodeflow, chunk 1", "GNU Radio, defaults", "GNU Radio, at most 1 item",
                                           "hand-written chain"};
  fmt::print("\nOne sample through 8 blocks\n\n| | p50 us | p99 us | p50 against the first |\n|---|---|---|---|\n");
  for (int row = 0; row < 4; ++row)
    fmt::print("| {} | {:.3f} | {:.3f} | {:.1f} |\n", kNames[row], bench::median(p50[row]) / 1e3, bench::median(p99[row]) / 1e3,
               bench::median(p50[row]) / bench::median(p50[0]));
}

}  // namespace

// bench_runtime [REPEATS] [multiply|feedback|latency|heavy]
int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::stoi(argv[1]) : 7;
  const std::string only = argc > 2 ? argv[2] : "";
  const auto wanted = [&](const char* name) { return only.empty() || only == name; };
  if (wanted("multiply"))
    for (const int blocks : {1, 4, 16}) multiply(blocks, repeats);
  if (wanted("feedback")) feedback(repeats);
  if (wanted("latency")) latency(repeats);
  if (wanted("heavy")) heavy(repeats);
}
