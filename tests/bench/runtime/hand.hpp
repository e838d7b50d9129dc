#pragma once

#include <cstddef>
#include <vector>

namespace bench {

/// `blocks` multiplications of `samples` doubles in chunks of 1024, all in one loop: what an engineer would write for this job
/// alone.
void hand_multiply(int blocks, std::size_t samples);

/// y = 0.5 x + 0.4 y[n-1], sample by sample: the loop of the feedback graph, written out.
void hand_feedback(std::size_t samples);

/// Ages in nanoseconds of single samples that pass 8 copies, functions of any number of samples called through pointers.
std::vector<double> hand_latency(std::size_t samples);

}  // namespace bench
