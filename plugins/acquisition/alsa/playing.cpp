#include "playing.hpp"

#include <bodeflow/units.hpp>

namespace bodeflow::acquisition {

void describe_lead(Describe& d) {
  d.optional<std::int64_t>("lead")
      .range(1, 1 << 24)
      .doc(
          "samples by which the output is late: what the device's buffer holds while the engine computes; all but a period of "
          "the buffer "
          "without it");
}

std::optional<std::size_t> read_lead(const Parameters& p, const PcmSpec& spec) {
  if (!p.has("lead")) return std::nullopt;
  const auto lead = static_cast<std::size_t>(p.integer("lead"));
  if (lead + spec.period > spec.buffer)
    fail("a lead of " + std::to_string(lead) + " samples in a buffer of " + std::to_string(spec.buffer) +
         "; allowed: up to buffer less a period, " + std::to_string(spec.buffer - spec.period));
  return lead;
}

void check_played(const StreamFacts& x, const Channels& channels, const std::string& clock) {
  if (!x.clock.empty() && x.clock != clock)
    fail("the input runs on clock '" + x.clock + "', the device on '" + clock +
         "'; allowed: the engine's own clock or that of the device, or put acquisition.resample between");
  for (std::size_t c = 0; c < channels.scales.size(); ++c) {
    const std::string& given = x.channel_units.empty() ? x.unit : x.channel_units[c];
    if (!same_unit(given, channels.scales[c].unit))
      fail("channel " + std::to_string(c + 1) + " of the input is in " + given + ", its scale in " + channels.scales[c].unit);
  }
}

}  // namespace bodeflow::acquisition
