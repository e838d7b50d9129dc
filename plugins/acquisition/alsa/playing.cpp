#include "playing.hpp"

#include <algorithm>
#include <bodeflow/units.hpp>
#include <cmath>
#include <limits>

#include "acquisition/sampling.hpp"

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

void advise_on_level(const StreamFacts& x, const Channels& channels, Advice& a) {
  const auto crest = x.note("excitation.crest_factor"), amplitudes = x.note("excitation.amplitudes");
  if (crest.empty() || amplitudes.empty() || channels.scales.empty()) return;
  double power = 0.0;
  for (const double peak : amplitudes) power += 0.5 * peak * peak;
  const double largest = crest.front() * std::sqrt(power);
  double full = std::numeric_limits<double>::infinity();
  for (const ChannelScale& s : channels.scales) full = std::min(full, std::abs(s.gain) - std::abs(s.offset));
  const std::string text = "the excitation reaches " + short_text(largest) + " of " + short_text(full) +
                           (channels.unit().empty() ? "" : " " + channels.unit()) + " at full scale";
  if (largest > full) {
    a.warn(text + ": what is above is cut off; lower the excitation");
  } else {
    a.tell(text);
  }
}

}  // namespace bodeflow::acquisition
