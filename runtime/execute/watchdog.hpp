#pragma once

#include <string>
#include <thread>
#include <vector>

#include "execute/run.hpp"

namespace bodeflow::execute {

/// A thread of a run and what it shows of itself.
struct Member {
  std::thread thread;
  Lane* lane = nullptr;
  std::string name;  ///< "thread 2"
};

/// Calls of all threads together: unchanged means no progress.
std::uint64_t calls_of(const std::vector<Member>& members);

/// How many times longer than other calls a block's finish may take: methods do their work there when all data have come.
inline constexpr double kFinishing = 60.0;

/// Whether a thread is in a block's finish.
bool in_finish(const std::vector<Member>& members);

/// Why nothing goes on: "dft waits for 1024 samples of adc.out, 0 are there; thread 2 in process of block 'adc' for 10 s".
std::string stall_report(Run& run, const std::vector<Member>& members, double seconds);

}  // namespace bodeflow::execute
