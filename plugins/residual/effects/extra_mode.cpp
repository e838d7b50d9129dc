#include "effects/extra_mode.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "effects/response_words.hpp"

namespace bodeflow::residual {
namespace {

constexpr std::size_t kStarts = 3;
// Modes of structures are damped by a few per cent. More damped it is a shape that follows anything broad.
constexpr double kMostDamping = 0.1;

/// How far line k stands out of the noise of what is missing.
double significance(const Situation& s, std::size_t k) {
  return s.missing_std[k] > 0.0 ? std::abs(s.missing[k]) / s.missing_std[k] : 0.0;
}

bool is_peak(const Situation& s, std::size_t k) {
  const double own = significance(s, k);
  return s.line_hz[k] > 0.0 && own > 0.0 && (k == 0 || significance(s, k - 1) <= own) &&
         (k + 1 == s.missing.size() || significance(s, k + 1) < own);
}

/// The frequency at which |missing| falls below `least` on the way from line `peak` by `step`; that of the end where it does not.
double edge(const Situation& s, std::size_t peak, std::ptrdiff_t step, double least) {
  std::size_t k = peak;
  const auto last = step < 0 ? std::size_t{0} : s.missing.size() - 1;
  while (k != last) {
    const std::size_t next = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(k) + step);
    const double own = std::abs(s.missing[k]), other = std::abs(s.missing[next]);
    if (other < least) return s.line_hz[k] + (own - least) / (own - other) * (s.line_hz[next] - s.line_hz[k]);
    k = next;
  }
  return s.line_hz[last];
}

/// Half the relative width in which |missing| stays above its peak over sqrt(2).
double half_width(const Situation& s, std::size_t peak) {
  const double least = std::abs(s.missing[peak]) / std::sqrt(2.0);
  return std::clamp(0.5 * (edge(s, peak, 1, least) - edge(s, peak, -1, least)) / s.line_hz[peak], 1e-3, kMostDamping);
}

}  // namespace

void ExtraMode::describe(DescribeEffect& effect) {
  effect.id("residual.extra_mode")
      .summary("One more resonance than the model has.")
      .doc(
          "2 zeta w (b s - a w) / (s^2 + 2 zeta w s + w^2) is added to the response: b + j a at the resonance. A mode seen by a "
          "sensor of position has b = 0, by one of velocity a = 0.")
      .acts(Acts::parallel);
}

std::vector<FitParameter> ExtraMode::parameters(const Situation& s) const {
  const std::string unit = lines::ratio_unit(s.output_unit, s.input_unit);
  double size = 0.0;
  for (const auto& m : s.missing) size = std::max(size, std::abs(m));
  if (!(size > 0.0)) size = 1.0;
  FitParameter frequency = positive("extra_mode_frequency", "Hz").says("resonance");
  // Seen from beside, a mode looks like many other things.
  if (!s.line_hz.empty() && s.line_hz.back() > 0.0) frequency.high = s.line_hz.back();
  return {std::move(frequency), positive("extra_mode_damping", "1").between(0.0, kMostDamping).says("damping ratio"),
          real("extra_mode_real", unit, size).says("real part of the added response at the resonance"),
          real("extra_mode_imaginary", unit, size).says("its imaginary part")};
}

std::vector<std::vector<double>> ExtraMode::starts(const Situation& s) const {
  std::vector<std::size_t> peaks;
  for (std::size_t k = 0; k < s.missing.size(); ++k)
    if (is_peak(s, k)) peaks.push_back(k);
  std::stable_sort(peaks.begin(), peaks.end(),
                   [&s](std::size_t a, std::size_t b) { return significance(s, a) > significance(s, b); });
  std::vector<std::vector<double>> starts;
  for (const std::size_t k : peaks) {
    const auto same = [&](const std::vector<double>& other) {
      return std::abs(other[0] - s.line_hz[k]) < 2.0 * other[0] * other[1];
    };
    if (std::any_of(starts.begin(), starts.end(), same)) continue;
    starts.push_back({s.line_hz[k], half_width(s, k), s.missing[k].real(), s.missing[k].imag()});
    if (starts.size() == kStarts) break;
  }
  if (starts.empty()) starts.push_back({lines::middle_omega(s) / lines::kTwoPi, 0.05, 0.0, 0.0});
  return starts;
}

std::string ExtraMode::sentence(std::span<const double> value, std::span<const double> std, const Situation&) const {
  return "one more resonance, at " + lines::with_std(value[0], std[0], "Hz") + " with " +
         lines::with_std(100.0 * value[1], 100.0 * std[1], "%", 3) + " of damping";
}

std::complex<double> ExtraMode::transfer(const double* p, std::complex<double> s) const {
  const double omega = lines::kTwoPi * p[0], twice = 2.0 * p[1] * omega;
  return twice * (p[2] * s - p[3] * omega) / (s * s + twice * s + omega * omega);
}

}  // namespace bodeflow::residual
