#pragma once

#include "rig.hpp"

namespace bodeflow::testing {

/// Puts into the feed what a name with '@' says about it: @rate, @channels, @channels.PORT, @note.PORT.NAME, @unconnected,
/// @period, @firings, @element. Throws Failure for a name or value that it does not know, and for a port that the block has not.
void set_feed(Feed& feed, const bf_block_descriptor& block, const std::string& name, const std::string& value);

}  // namespace bodeflow::testing
