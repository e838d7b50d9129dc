#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace bench {

/// Sums over the periods of two signals, at each line: what a response with its variance is made from.
struct Sums {
  std::vector<std::complex<double>> input, output, cross;
  std::vector<double> input_power, output_power;
};

/// FFTW and one loop, as one would write it by hand: `periods` times the same N samples of input and output.
Sums hand_sums(std::span<const double> input, std::span<const double> output, std::size_t periods);

}  // namespace bench
