#include "interleave.hpp"

#include <fmt/format.h>

#include "measure.hpp"

namespace bench {

void interleave(std::vector<Candidate>& candidates, std::size_t samples, int repeats) {
  for (auto& candidate : candidates) candidate.run();
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (auto& candidate : candidates) {
      const Cost cost = measure(samples, candidate.run);
      candidate.cpu_ns.push_back(cost.cpu_ns);
      candidate.wall_ns.push_back(cost.wall_ns);
    }
}

void print(const std::string& title, const std::vector<Candidate>& candidates) {
  fmt::print("\n{}\n\n| | CPU ns/sample | wall ns/sample | CPU against the first |\n|---|---|---|---|\n", title);
  const double first = median(candidates.front().cpu_ns);
  for (const auto& candidate : candidates)
    fmt::print("| {} | {:.3f} | {:.3f} | {:.2f} |\n", candidate.name, median(candidate.cpu_ns), median(candidate.wall_ns),
               median(candidate.cpu_ns) / first);
}

}  // namespace bench
