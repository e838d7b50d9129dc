#include "notes.hpp"

#include <algorithm>
#include <cmath>

namespace bodeflow::filters {

Notes scaled(Notes notes, double factor) {
  for (const char* name : {"excitation.amplitudes", "noise.std"}) {
    const auto found = notes.find(name);
    if (found == notes.end()) continue;
    for (double& value : found->second) value *= std::abs(factor);
  }
  return notes;
}

Notes added(const Notes& a, const Notes& b) {
  Notes sum = a;
  for (const auto& [name, values] : b) {
    const auto [place, fresh] = sum.emplace(name, values);
    if (fresh) continue;
    if (name == "noise.std" && values.size() == 1 && place->second.size() == 1) {
      place->second[0] = std::hypot(place->second[0], values[0]);
    } else if (place->second != values) {
      sum.erase(place);
    }
  }
  return sum;
}

Notes filtered(const Notes& notes, double settling_s) {
  Notes kept;
  for (const char* name : {"excitation.period", "excitation.experiment", "excitation.frequencies", "plant.modes"}) {
    const auto found = notes.find(name);
    if (found != notes.end()) kept.insert(*found);
  }
  const auto before = notes.find("plant.settling_time");
  const double least = before == notes.end() || before->second.empty() ? 0.0 : before->second[0];
  kept["plant.settling_time"] = {std::max(settling_s, least)};
  return kept;
}

}  // namespace bodeflow::filters
