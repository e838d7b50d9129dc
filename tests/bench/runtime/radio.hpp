#pragma once

#include <cstddef>
#include <vector>

namespace bench {

/// GNU Radio: null source, `blocks` times multiply_const_ff, head, null sink. `small_buffers`: its low-latency setting, at most
/// 256 items a call.
void radio_multiply(int blocks, std::size_t samples, bool low_latency);

/// Ages in nanoseconds of single samples from a source, which waits until the sink has seen each, through 8 copies.
std::vector<double> radio_latency(std::size_t samples, bool low_latency);

}  // namespace bench
