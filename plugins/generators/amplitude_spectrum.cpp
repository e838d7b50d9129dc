#include "amplitude_spectrum.hpp"

#include <bodeflow/numerics/random.hpp>
#include <string>

#include "hertz.hpp"
#include "portable_exp.hpp"

namespace bodeflow::generators {
namespace {

using numerics::Expected;
using numerics::portable_log;
using numerics::refused;

// A frequency this far outside, relative, is an end of the curve up to the rounding of decimal numbers.
constexpr double kRounding = 1e-9;

Expected<void> require_curve(std::span<const double> frequencies, std::span<const double> amplitudes) {
  if (frequencies.size() != amplitudes.size() || frequencies.empty()) {
    return refused("spectrum has " + std::to_string(frequencies.size()) + " frequencies and " +
                   std::to_string(amplitudes.size()) + " amplitudes; allowed: as many of both, at least one");
  }
  for (std::size_t i = 0; i < frequencies.size(); ++i) {
    if (!(frequencies[i] > (i == 0 ? 0.0 : frequencies[i - 1])))
      return refused("spectrum.frequencies are not rising and above zero at " + hertz(frequencies[i]));
    if (!(amplitudes[i] > 0)) return refused("spectrum.amplitudes are not above zero at " + hertz(frequencies[i]));
  }
  return {};
}

}  // namespace

Expected<std::vector<double>> amplitudes_on_curve(std::span<const double> point_frequencies,
                                                  std::span<const double> point_amplitudes, std::span<const double> frequencies) {
  if (auto curve = require_curve(point_frequencies, point_amplitudes); !curve) return tl::make_unexpected(curve.error());
  const double lowest = point_frequencies.front(), highest = point_frequencies.back();
  std::vector<double> amplitudes;
  std::size_t after = 0;
  for (const double f : frequencies) {
    if (f < lowest * (1 - kRounding) || f > highest * (1 + kRounding)) {
      return refused("a line at " + hertz(f) + " lies outside of spectrum.frequencies, " + hertz(lowest) + " to " +
                     hertz(highest));
    }
    while (after < point_frequencies.size() && point_frequencies[after] <= f) ++after;
    if (after == 0 || after == point_frequencies.size()) {
      amplitudes.push_back(point_amplitudes[after == 0 ? 0 : after - 1]);
      continue;
    }
    const double span = portable_log(point_frequencies[after] / point_frequencies[after - 1]);
    const double share = portable_log(f / point_frequencies[after - 1]) / span;
    const double rise = portable_log(point_amplitudes[after] / point_amplitudes[after - 1]);
    amplitudes.push_back(point_amplitudes[after - 1] * portable_exp(share * rise));
  }
  return amplitudes;
}

}  // namespace bodeflow::generators
