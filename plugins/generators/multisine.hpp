#pragma once

#include <bodeflow/numerics/random.hpp>
#include <cstdint>
#include <span>
#include <vector>

namespace bodeflow::generators {

/// One line of a multisine: amplitude (peak) and phase [rad] of cos(2 pi k n / N + phase).
struct Line {
  std::int64_t k = 0;
  double amplitude = 0.0;
  double phase_rad = 0.0;
};

/// phi_i = -i (i - 1) pi / M for i = 1 .. M, in (-2 pi, 0]: low crest factor for equal amplitudes.
/// Source: M. R. Schroeder, "Synthesis of low-peak-factor signals and binary sequences with low autocorrelation", IEEE Trans.
/// Inf. Theory 16, 1970.
std::vector<double> schroeder_phases(std::size_t lines);

/// `lines` phases independent and uniform on (0, 2 pi).
std::vector<double> random_phases(std::size_t lines, numerics::Random random);

/// One period x[n] = sum_i a_i cos(2 pi k_i n / N + phi_i), n = 0 .. N-1. `period` is N >= 2; each k is in 1 .. (N-1)/2.
/// Method: a Fourier sum by factors of N (mixed radix), its factors cos and sin of whole fractions of a turn, good to rounding.
/// Own code in place of a library so that the bits of an excitation are the same on every machine. Cost: O(N sum of the prime
/// factors of N).
std::vector<double> synthesise(std::int64_t period, std::span<const Line> lines);

/// Peak over root mean square; 0 for a signal that is zero.
double crest_factor(std::span<const double> x);

}  // namespace bodeflow::generators
