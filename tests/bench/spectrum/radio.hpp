#pragma once

#include <cstddef>
#include <vector>

namespace bench {

/// GNU Radio's blocks for the same sums: vectors of one period, FFT, powers and cross product, sums over all periods. Runs
/// `periods` times the same samples.
void radio_sums(const std::vector<float>& input, const std::vector<float>& output, std::size_t periods);

}  // namespace bench
