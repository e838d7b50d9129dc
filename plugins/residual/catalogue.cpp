#include "catalogue.hpp"

#include <algorithm>

#include "old_effects/dead_time.hpp"
#include "old_effects/delay.hpp"
#include "old_effects/saturation.hpp"
#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

Catalogue all_effects() {
  Catalogue all;
  all.push_back(std::make_unique<Delay>());
  all.push_back(std::make_unique<DeadTime>());
  all.push_back(std::make_unique<Saturation>());
  return all;
}

}  // namespace

std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const auto& effect : all_effects()) names.push_back(effect->name());
  return names;
}

Expected<Catalogue> catalogue(const std::vector<std::string>& names) {
  Catalogue all = all_effects(), chosen;
  if (names.empty()) return all;
  for (const std::string& name : names) {
    const auto same = [&name](const auto& effect) { return effect && effect->name() == name; };
    const auto found = std::find_if(all.begin(), all.end(), same);
    if (found == all.end()) {
      std::string known;
      for (const std::string& other : effect_names()) known += (known.empty() ? "" : ", ") + other;
      const bool twice = std::any_of(chosen.begin(), chosen.end(), same);
      return refused("effect '" + name + (twice ? "' is named twice" : "' is not known; there are: " + known));
    }
    chosen.push_back(std::move(*found));
  }
  return chosen;
}

bool is_linear(const Extension& extension) {
  return std::all_of(extension.begin(), extension.end(), [](const AddedEffect& a) { return a.effect->linear(); });
}

double delay_s(const Extension& extension) {
  double sum = 0.0;
  for (const AddedEffect& added : extension) sum += added.effect->delay_s(added.values.data());
  return sum;
}

std::string beyond(const Parameter& p, double value) {
  const auto text = [&p](double bound) { return records::short_number(bound, 3) + (p.unit == "1" ? "" : " " + p.unit); };
  if (!(value >= p.low)) return "below " + text(p.low);
  if (!(value <= p.high)) return "above " + text(p.high);
  return "";
}

}  // namespace bodeflow::residual
