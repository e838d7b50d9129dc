#include "sensor_stream.hpp"

#include <bodeflow/error.hpp>
#include <bodeflow/units.hpp>
#include <cmath>

namespace bodeflow::drive {

void check_unit(const StreamFacts& facts, const std::string& unit) {
  if (same_unit(facts.unit, unit)) return;
  fail("the input is in " + facts.unit + ", allowed: " + unit);
}

void check_finite(std::span<const double> x, int channel, std::uint64_t first) {
  for (std::size_t n = 0; n < x.size(); ++n) {
    if (std::isfinite(x[n])) continue;
    fail("sample " + std::to_string(first + n) + " of channel " + std::to_string(channel + 1) + " is " +
         (std::isnan(x[n]) ? "NaN" : "infinite") + ", allowed: finite values");
  }
}

void check_at_start(std::uint64_t position) {
  if (position > 0) fail("properties: a record before sample " + std::to_string(position) + ", allowed: before the first");
}

void add_noise_note(StreamFacts& output, const SensorErrors& errors, bool filtered) {
  const bool noisy_input = output.notes.count("noise.std") != 0;
  if (filtered && noisy_input) {
    output.notes.erase("noise.std");
    return;
  }
  if (!noisy_input && errors.noise_std == 0) return;
  std::vector<double>& noise = output.notes["noise.std"];
  if (noise.empty()) noise = {0.0};
  for (double& std : noise) std = std::hypot(errors.gain * std, errors.noise_std);
}

}  // namespace bodeflow::drive
