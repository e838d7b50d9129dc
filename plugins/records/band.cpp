#include "band.hpp"

#include <bodeflow/units.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "signals.hpp"

namespace bodeflow::records {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

/// The unit behind a number, "" where there is none.
std::string unit_of(const std::string& end) {
  const auto at = end.find_first_not_of("0123456789.+-eE \t");
  return at == std::string::npos ? "" : end.substr(at);
}

Expected<double> end_of(const std::string& text, const std::string& unit, double sample_rate_hz) {
  const std::string whole = unit_of(text).empty() && !unit.empty() ? text + " " + unit : text;
  const std::string own = unit_of(whole);
  if (own.empty()) {
    auto value = convert(whole, "1");
    if (!value) return unexpected(value.error().text);
    if (sample_rate_hz <= 0.0) return unexpected("'" + text + "' has no unit; needed here: Hz or rad/s");
    return *value * sample_rate_hz;
  }
  if (own == "rad/sample") {
    auto value = convert(trimmed(whole.substr(0, whole.size() - own.size())), "1");
    if (!value) return unexpected(value.error().text);
    if (sample_rate_hz <= 0.0) return unexpected("'" + whole + "': the data have no sample rate; needed here: Hz or rad/s");
    return *value * sample_rate_hz;
  }
  if (auto hertz = convert(whole, "Hz")) return 2.0 * std::numbers::pi * *hertz;
  if (auto angular = convert(whole, "rad/s")) return *angular;
  return unexpected("'" + whole + "' is no frequency; allowed: numbers in rad/sample, or with Hz or rad/s");
}

}  // namespace

Expected<Band> parse_band(const std::string& text, double sample_rate_hz) {
  const double half = sample_rate_hz > 0.0 ? std::numbers::pi * sample_rate_hz : std::numeric_limits<double>::infinity();
  const std::string found = "band '" + text + "': ";
  if (trimmed(text).empty()) return Band{0.0, half};
  const auto colon = text.find(':');
  if (colon == std::string::npos || text.find(':', colon + 1) != std::string::npos)
    return unexpected(found + "allowed: two ends with a colon between, such as 0:0.625 or 1 Hz:50 Hz");
  const std::string low = trimmed(text.substr(0, colon)), high = trimmed(text.substr(colon + 1));
  Band band{0.0, half};
  if (!low.empty()) {
    auto value = end_of(low, unit_of(high), sample_rate_hz);
    if (!value) return unexpected(found + value.error().text);
    band.low_rad_s = *value;
  }
  if (!high.empty()) {
    auto value = end_of(high, "", sample_rate_hz);
    if (!value) return unexpected(found + value.error().text);
    band.high_rad_s = *value;
  }
  if (!(band.low_rad_s >= 0.0) || !(band.high_rad_s > band.low_rad_s)) return unexpected(found + "the ends must rise from 0 on");
  constexpr double kRounding = 1e-9;  // 3.14159265 rad/sample means half the rate
  if (band.high_rad_s > half * (1.0 + kRounding))
    return unexpected(found + "the upper end is above half the sample rate (" + short_number(sample_rate_hz / 2.0) + " Hz)");
  return band;
}

}  // namespace bodeflow::records
