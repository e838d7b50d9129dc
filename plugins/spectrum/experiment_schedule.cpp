#include "experiment_schedule.hpp"

namespace bodeflow::spectrum {
namespace {

// Positions stay exact in 64 bits, and in a double.
constexpr std::int64_t kLongest = std::int64_t{1} << 53;

}  // namespace

std::string fault_of(const Schedule& s) {
  const std::string many = std::to_string(s.count()) + " experiments (realisations " + std::to_string(s.realisations) +
                           " x experiments " + std::to_string(s.experiments) + ")";
  if (s.count() > 1 && s.periods == 0) return many + " need `periods`: how many are averaged in each";
  if (s.periods == 1 && s.realisations == 1)
    return "periods is 1; the variance needs at least 2 periods, or several realisations";
  const double length = static_cast<double>(s.count()) * static_cast<double>(s.skip + s.periods) * static_cast<double>(s.period);
  if (length > static_cast<double>(kLongest)) return many + " of " + std::to_string(s.skip + s.periods) + " periods are too long";
  if (s.starts.empty()) return "";
  if (static_cast<std::int64_t>(s.starts.size()) != s.count())
    return "starts has " + std::to_string(s.starts.size()) + " entries; needed: one for each of " + many;
  for (std::size_t i = 0; i < s.starts.size(); ++i) {
    if (s.starts[i] < 0 || s.starts[i] > kLongest) return "starts: " + std::to_string(s.starts[i]) + "; allowed: 0 and above";
    if (i > 0 && s.starts[i] < s.starts[i - 1] + (s.skip + s.periods) * s.period) {
      return "starts: " + std::to_string(s.starts[i]) + " is inside the experiment that starts at " +
             std::to_string(s.starts[i - 1]) + " and is " + std::to_string((s.skip + s.periods) * s.period) + " samples long";
    }
  }
  return "";
}

std::string name_of(const Schedule& s, std::int64_t i) {
  const std::string realisation = "realisation " + std::to_string(i / s.experiments + 1);
  if (s.experiments == 1) return realisation;
  const std::string experiment = "experiment " + std::to_string(i % s.experiments + 1);
  return s.realisations == 1 ? experiment : experiment + " of " + realisation;
}

}  // namespace bodeflow::spectrum
