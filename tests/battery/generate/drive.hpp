#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "generate/random.hpp"

namespace battery {

using Series = std::vector<double>;
using Complex = std::complex<double>;

/// Steps that a sample is simulated in.
constexpr std::size_t kSubsteps = 16;
/// Periods written to a file: one that nobody is to use, six to be used.
constexpr std::size_t kPeriods = 7;
/// Periods before the record begins, in which the plant settles.
constexpr std::size_t kSettling = 1;

/// One experiment: a multisine a cos(2 pi k n / period + phase_k) of equal amplitudes, repeated.
struct Drive {
  std::size_t period = 0;
  double sample_time = 0.0;
  double level = 1.0;
  double amplitude = 0.0;  ///< of a line, the level included
  std::vector<int> lines;
  Series phases;
  Series half_steps;  ///< one period on a grid of 2 kSubsteps values a sample

  double sample(std::size_t n) const { return half_steps[(n % period) * 2 * kSubsteps]; }
  Complex line(std::size_t j) const { return std::polar(amplitude, phases[j]); }
  double omega(std::size_t j) const;                                           ///< of line j [rad/s]
  std::size_t samples() const { return period * kPeriods; }                    ///< of the record
  std::size_t all_samples() const { return period * (kPeriods + kSettling); }  ///< with those before it
  /// Time since the record began, of a substep counted from the beginning of the simulation.
  double time(double substep) const {
    return (substep / static_cast<double>(kSubsteps) - static_cast<double>(kSettling * period)) * sample_time;
  }
};

/// A drive with phases of its own. `rms` is the input's at level 1.
Drive make_drive(const std::vector<int>& lines, std::size_t period, double sample_time, double rms, double level, Random& random);

/// Lines without one of every four, which one is random: what stays empty shows nonlinearity.
std::vector<int> leave_some_out(const std::vector<int>& lines, Random& random);

/// Fourier coefficients c of mean-period samples at the lines: sum of Re(c exp(j 2 pi k n / period)).
std::vector<Complex> coefficients(const Series& one_period, const std::vector<int>& lines);

/// Samples of the record of a periodic signal: the sum of Re(c exp(j 2 pi k n / period)) over the lines.
Series from_coefficients(const Drive& d, const std::vector<Complex>& c);

/// Samples of the record from a simulation on the grid of substeps, settling included.
Series sampled(const Drive& d, const Series& fine);

double mean_square(const Series& values);
double root_mean_square(const Series& values);
double peak(const Series& values);

}  // namespace battery
