#include "multisine.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "phase.hpp"

namespace bodeflow::generators {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

Complex product(Complex a, Complex b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

// exp(2 pi i m / count), m = 0 .. count-1.
std::vector<Complex> turns(std::size_t count) {
  std::vector<Complex> table(count);
  const double size = static_cast<double>(count);
  for (std::size_t m = 0; m < count; ++m) {
    const double cycles = (2 * m <= count ? static_cast<double>(m) : static_cast<double>(m) - size) / size;
    const double quarter_on = cycles > 0.25 ? cycles - 0.75 : cycles + 0.25;
    table[m] = {sine_of_cycles(quarter_on), sine_of_cycles(cycles)};
  }
  return table;
}

std::size_t smallest_factor(std::size_t n) {
  for (std::size_t p = 2; p * p <= n; ++p) {
    if (n % p == 0) return p;
  }
  return n;
}

// Sums x[n] = sum_k X[k] exp(2 pi i k n / N) by decimation in k.
class FourierSum {
 public:
  explicit FourierSum(std::size_t size) : turns_(turns(size)), group_(size) {}

  void run(const Complex* lines, std::size_t stride, Complex* x, std::size_t count) {
    if (count == 1) {
      x[0] = lines[0];
      return;
    }
    const std::size_t radix = smallest_factor(count);
    const std::size_t part = count / radix;
    for (std::size_t r = 0; r < radix; ++r) run(lines + r * stride, stride * radix, x + r * part, part);
    for (std::size_t n = 0; n < part; ++n) join(x, n, part, radix, stride);
  }

 private:
  // The outputs n, n + part, n + 2 part ... from output n of each part.
  void join(Complex* x, std::size_t n, std::size_t part, std::size_t radix, std::size_t stride) {
    const std::size_t size = turns_.size();
    for (std::size_t r = 0; r < radix; ++r) group_[r] = product(x[r * part + n], turns_[r * n * stride % size]);
    for (std::size_t q = 0; q < radix; ++q) {
      Complex sum = group_[0];
      for (std::size_t r = 1; r < radix; ++r) sum += product(group_[r], turns_[r * q % radix * (size / radix)]);
      x[q * part + n] = sum;
    }
  }

  std::vector<Complex> turns_;
  std::vector<Complex> group_;
};

}  // namespace

std::vector<double> schroeder_phases(std::size_t lines) {
  std::vector<double> phases(lines);
  for (std::size_t i = 1; i <= lines; ++i) {
    // Reduced modulo 2 pi while still whole: i (i - 1) / M counts half turns.
    const std::size_t half_turns = i * (i - 1) % (2 * lines);
    phases[i - 1] = -pi * static_cast<double>(half_turns) / static_cast<double>(lines);
  }
  return phases;
}

std::vector<double> random_phases(std::size_t lines, numerics::Random random) {
  std::vector<double> phases(lines);
  for (double& phase : phases) phase = 2 * pi * random.uniform();
  return phases;
}

std::vector<double> synthesise(std::int64_t period, std::span<const Line> lines) {
  const auto size = static_cast<std::size_t>(period);
  std::vector<Complex> spectrum(size), x(size);
  for (const Line& line : lines) {
    const Phase phase = Phase::from_radians(line.phase_rad);
    Phase quarter_on = phase;
    quarter_on += Phase::from_radians(0.5 * pi);
    spectrum[static_cast<std::size_t>(line.k)] +=
        Complex(line.amplitude * sine_of_cycles(quarter_on.cycles()), line.amplitude * sine_of_cycles(phase.cycles()));
  }
  FourierSum(size).run(spectrum.data(), 1, x.data(), size);
  std::vector<double> samples(size);
  std::transform(x.begin(), x.end(), samples.begin(), [](Complex value) { return value.real(); });
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
