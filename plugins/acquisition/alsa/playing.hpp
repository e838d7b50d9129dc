#pragma once

#include "card.hpp"

namespace bodeflow::acquisition {

/// Describes lead: how far the playback's buffer is filled ahead.
void describe_lead(Describe& d);
/// None: all but a period of the buffer.
std::optional<std::size_t> read_lead(const Parameters& p, const PcmSpec& spec);

/// Throws Failure for a stream to be played whose unit is another one than that of the scale, or whose clock is that of
/// another device.
void check_played(const StreamFacts& x, const Channels& channels, const std::string& clock);

/// Tells how far what is known of the stream fills the converter, and warns where it is limited.
void advise_on_level(const StreamFacts& x, const Channels& channels, Advice& a);

}  // namespace bodeflow::acquisition
