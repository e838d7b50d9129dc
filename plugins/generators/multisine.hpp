#pragma once

#include <bodeflow/numerics/random.hpp>
#include <complex>
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

/// Phases [rad], in (-2 pi, 0], that make the multisine a sweep, its time at each line in proportion to the power there:
/// phi_i = phi_(i-1) - 2 pi (k_i - k_(i-1)) / d * (p_1 + ... + p_(i-1)), p the shares of the power, d the common factor of the
/// distances k_i - k_(i-1). For equal amplitudes on evenly spaced lines that is -i (i - 1) pi / M for i = 1 .. M. The lines are
/// ascending, not all amplitudes zero. Wrong for few lines far apart, which have no time of their own.
/// Source: M. R. Schroeder, "Synthesis of low-peak-factor signals and binary sequences with low autocorrelation", IEEE Trans.
/// Inf. Theory 16, 1970, doi:10.1109/TIT.1970.1054411.
std::vector<double> schroeder_phases(std::span<const Line> lines);

/// `lines` phases independent and uniform on (0, 2 pi).
std::vector<double> random_phases(std::size_t lines, numerics::Random random);

/// One period z[n] = sum_i a_i exp(i (2 pi k_i n / N + phi_i)), n = 0 .. N-1: the multisine and, as imaginary part, the one with
/// all phases a quarter of a turn behind. `period` is N >= 2; each k is in 1 .. (N-1)/2. Good to rounding; cost: see FourierSum.
std::vector<std::complex<double>> synthesise_analytic(std::int64_t period, std::span<const Line> lines);

/// Its real part: one period x[n] = sum_i a_i cos(2 pi k_i n / N + phi_i).
std::vector<double> synthesise(std::int64_t period, std::span<const Line> lines);

/// Peak over root mean square; 0 for a signal that is zero.
double crest_factor(std::span<const double> x);

}  // namespace bodeflow::generators
