#include "frequency_steps.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "hertz.hpp"

namespace bodeflow::generators {

double FrequencyStep::frequency_hz(Rate rate) const {
  return static_cast<double>(cycles) * static_cast<double>(rate.num) /
         (static_cast<double>(rate.den) * static_cast<double>(window));
}

Expected<FrequencyStep> place_frequency(double wanted_hz, Rate rate, double tolerance) {
  if (!(wanted_hz > 0.0) || !(2.0 * wanted_hz < rate.hz()))
    return unexpected("frequency " + hertz(wanted_hz) + "; allowed: above 0 and below half of the sample rate, " +
                      hertz(0.5 * rate.hz()));
  const double samples_a_cycle = rate.hz() / wanted_hz;
  for (std::int64_t cycles = 1;; ++cycles) {
    const double exact = static_cast<double>(cycles) * samples_a_cycle;
    if (!(exact <= static_cast<double>(kLongestWindow)))
      return unexpected("frequency " + hertz(wanted_hz) + " needs a window of " +
                        std::to_string(static_cast<std::int64_t>(std::min(exact, 9e18))) + " samples; allowed: " +
                        std::to_string(kLongestWindow) + "; lower the sample rate or raise the tolerance");
    const double window = std::round(exact);
    // rate m / N over the wanted frequency is exact / N.
    if (!(std::abs(exact / window - 1.0) <= tolerance) || !(window > 2.0 * static_cast<double>(cycles)) || window < 3.0) continue;
    return FrequencyStep{wanted_hz, cycles, static_cast<std::int64_t>(window)};
  }
}

Expected<std::vector<FrequencyStep>> place_frequencies(const std::vector<double>& wanted_hz, Rate rate, double tolerance) {
  std::vector<FrequencyStep> steps;
  for (const double wanted : wanted_hz) {
    const auto step = place_frequency(wanted, rate, tolerance);
    if (!step) return unexpected(step.error().text);
    const auto same = std::find_if(steps.begin(), steps.end(), [&](const FrequencyStep& other) {
      return other.cycles == step->cycles && other.window == step->window;
    });
    if (same != steps.end()) {
      return unexpected("frequencies " + hertz(same->wanted_hz) + " and " + hertz(wanted) + " both fall on " +
                        hertz(step->frequency_hz(rate)) + ", " + std::to_string(step->cycles) + " cycles in " +
                        std::to_string(step->window) + " samples; lower the tolerance");
    }
    steps.push_back(*step);
  }
  return steps;
}

std::vector<double> frequency_grid(double first_hz, double last_hz, std::int64_t count, bool logarithmic) {
  std::vector<double> grid;
  for (std::int64_t k = 0; k < count; ++k) {
    const double share = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0.0;
    grid.push_back(logarithmic ? first_hz * std::pow(last_hz / first_hz, share) : first_hz + (last_hz - first_hz) * share);
  }
  if (count > 1) grid.back() = last_hz;
  return grid;
}

}  // namespace bodeflow::generators
