#include "trace/remedy.hpp"

#include <algorithm>
#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::residual {

std::optional<double> remedy_value(const RemedyKind& kind, const std::vector<NamedEffect>& named, double factor,
                                   const std::string& place) {
  for (const NamedEffect& effect : named) {
    if (effect.name != kind.effect || (!place.empty() && effect.place != place)) continue;
    const auto at = std::find(effect.parameter_names.begin(), effect.parameter_names.end(), kind.value);
    if (at == effect.parameter_names.end()) continue;
    const auto n = static_cast<std::size_t>(at - effect.parameter_names.begin());
    if (n >= effect.values.size()) continue;
    const double value = factor * effect.values[n];
    if (!std::isfinite(value) || value == 0.0 || (kind.positive && value < 0.0)) continue;
    return value;
  }
  return std::nullopt;
}

std::optional<Remedied> remedied(const RemedyKind& kind, const std::vector<NamedEffect>& named, double factor,
                                 const std::string& place, double steady_gain) {
  if (const auto own = remedy_value(kind, named, factor, place)) return Remedied{kind.effect, *own};
  const std::string twin = kind.twin;
  if (twin.empty()) return std::nullopt;
  const RemedyKind like{kind.twin, kind.twin, kind.parameter, kind.positive};
  const auto found = remedy_value(like, named, factor * steady_gain, place);
  return found ? std::optional(Remedied{twin, *found}) : std::nullopt;
}

std::string amount_text(double value, const std::string& unit) {
  if (unit == "s" && std::abs(value) < 1e-3) return records::short_number(1e6 * value, 4) + " us";
  return records::short_number(value, 4) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

std::string remedy_words(const RemedyKind& kind, double value, const std::string& unit) {
  const std::string amount = amount_text(value, unit);
  const std::string effect = kind.effect;
  if (effect == "delay") return "commands sent " + amount + " earlier";
  if (effect == "dead_time") return "dead-time compensation of " + amount;
  if (effect == "offset") return "an offset of " + amount + " taken off the measurement";
  return "friction feed-forward of " + amount;
}

}  // namespace bodeflow::residual
