#include "multisine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "fourier_sum.hpp"
#include "phase.hpp"

namespace bodeflow::generators {

using std::numbers::pi;

std::vector<double> schroeder_phases(std::span<const Line> lines) {
  std::int64_t common = 0;
  double power = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    power += lines[i].amplitude * lines[i].amplitude;
    if (i > 0) common = std::gcd(common, lines[i].k - lines[i - 1].k);
  }
  std::vector<double> phases(lines.size());
  double below = 0, cycles = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    below += lines[i - 1].amplitude * lines[i - 1].amplitude;
    cycles += static_cast<double>((lines[i].k - lines[i - 1].k) / common) * (below / power);
    cycles -= std::floor(cycles);
    phases[i] = -2 * pi * cycles;
  }
  return phases;
}

std::vector<double> random_phases(std::size_t lines, numerics::Random random) {
  std::vector<double> phases(lines);
  for (double& phase : phases) phase = 2 * pi * random.uniform();
  return phases;
}

std::vector<std::complex<double>> synthesise_analytic(std::int64_t period, std::span<const Line> lines) {
  const auto size = static_cast<std::size_t>(period);
  std::vector<std::complex<double>> spectrum(size), z(size);
  for (const Line& line : lines)
    spectrum[static_cast<std::size_t>(line.k)] += line.amplitude * turn_of_cycles(Phase::from_radians(line.phase_rad).cycles());
  FourierSum(size).run(spectrum, z);
  return z;
}

std::vector<double> synthesise(std::int64_t period, std::span<const Line> lines) {
  const std::vector<std::complex<double>> z = synthesise_analytic(period, lines);
  std::vector<double> samples(z.size());
  std::transform(z.begin(), z.end(), samples.begin(), [](std::complex<double> value) { return value.real(); });
  return samples;
}

double crest_factor(std::span<const double> x) {
  double peak = 0;
  double energy = 0;
  for (const double value : x) {
    peak = std::max(peak, std::abs(value));
    energy += value * value;
  }
  return energy > 0 ? peak / std::sqrt(energy / static_cast<double>(x.size())) : 0.0;
}

}  // namespace bodeflow::generators
