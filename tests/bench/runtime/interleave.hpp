#pragma once

#include <functional>
#include <string>
#include <vector>

namespace bench {

/// One of several ways to do the same work, and what its runs cost.
struct Candidate {
  std::string name;
  std::function<void()> run;
  std::vector<double> cpu_ns, wall_ns;  ///< per sample, of each run
};

/// Runs the candidates in turn, `repeats` times, after one run of each that does not count.
void interleave(std::vector<Candidate>& candidates, std::size_t samples, int repeats);

/// Prints medians as a table.
void print(const std::string& title, const std::vector<Candidate>& candidates);

}  // namespace bench
