#include "peak_norm.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "phase.hpp"

namespace bodeflow::generators {
namespace {

// Points a period of the highest line, at least. With fewer the p-norm misses peaks between them, and its descent ends in worse
// minima: crest factors of flat lines are near 1.6 with 4 points, 1.43 with 6, 1.39 with 12.
constexpr std::int64_t kOversampling = 12;

// With a common factor of the lines the signal repeats within the period.
std::vector<Line> reduced(std::span<const Line> lines) {
  std::int64_t common = 0;
  for (const Line& line : lines) common = std::gcd(common, line.k);
  std::vector<Line> result(lines.begin(), lines.end());
  for (Line& line : result) line.k /= common;
  return result;
}

}  // namespace

std::size_t PeakNorm::points_for(std::span<const Line> lines) {
  std::int64_t highest = 0;
  for (const Line& line : reduced(lines)) highest = std::max(highest, line.k);
  return std::bit_ceil(static_cast<std::size_t>(kOversampling * highest));
}

PeakNorm::PeakNorm(std::span<const Line> lines)
    : lines_(reduced(lines)),
      sum_(points_for(lines_)),
      spectrum_(points_for(lines_)),
      signal_(spectrum_.size()),
      turned_(lines_.size()) {}

double PeakNorm::evaluate(const std::vector<double>& cycles, int power, std::vector<double>& gradient) {
  std::fill(spectrum_.begin(), spectrum_.end(), FourierSum::Complex());
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    turned_[i] = lines_[i].amplitude * turn_of_cycles(cycles[i] - std::nearbyint(cycles[i]));
    spectrum_[static_cast<std::size_t>(lines_[i].k)] = turned_[i];
  }
  sum_.run(spectrum_, signal_);
  peak_ = 0;
  for (const FourierSum::Complex& x : signal_) peak_ = std::max(peak_, std::abs(x.real()));
  // total = sum (|x| / peak)^p, and spectrum_ becomes (x / peak)^(p - 1): d total / d x is p spectrum_ / peak.
  double total = 0;
  for (std::size_t n = 0; n < signal_.size(); ++n) {
    const double x = signal_[n].real() / peak_;
    double odd = x, full = x * x;
    for (int i = 1; i < power; ++i) {
      odd *= full;
      full *= full;
    }
    total += full;
    spectrum_[n] = odd;
  }
  // d x[n] / d cycles_i = 2 pi Re(i turned_i exp(2 pi i k_i n / N)).
  sum_.run(spectrum_, signal_);
  const double scale = 2 * std::numbers::pi / (total * peak_);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const FourierSum::Complex slope = signal_[static_cast<std::size_t>(lines_[i].k)];
    gradient[i] = -scale * (turned_[i].imag() * slope.real() + turned_[i].real() * slope.imag());
  }
  const double mean = total / static_cast<double>(points());
  return numerics::portable_log(peak_) + numerics::portable_log(mean) / static_cast<double>(1 << power);
}

}  // namespace bodeflow::generators
