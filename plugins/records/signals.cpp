#include "signals.hpp"

#include <cstdio>

#include "response_units.hpp"

namespace bodeflow::records {

Signals signals_of(const StreamFacts& facts, const std::string& port) {
  Signals s;
  for (std::size_t c = 0; c < static_cast<std::size_t>(facts.channels); ++c) {
    std::string name = c < facts.channel_names.size() ? facts.channel_names[c] : "";
    if (name.empty()) name = facts.channels == 1 ? port : port + "_" + std::to_string(c + 1);
    s.names.push_back(std::move(name));
    const bool own = c < facts.channel_units.size() && !facts.channel_units[c].empty();
    s.units.push_back(own ? facts.channel_units[c] : facts.unit);
  }
  return s;
}

std::vector<std::string> response_units(const std::vector<std::string>& output_units,
                                        const std::vector<std::string>& input_units) {
  std::vector<std::string> units;
  for (const std::string& y : output_units) {
    for (const std::string& u : input_units) units.push_back(ratio_unit(y, u));
  }
  return units;
}

std::string short_number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

std::string counted(std::int64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace bodeflow::records
