#pragma once

#include <bodeflow/block.hpp>

#include "hidden_effect.hpp"

namespace bodeflow::drive {

/// The parameters `effects`, `outside`, `odds`, `seed`, and `size.NAME` for each of the table.
void describe_draw(Describe& d, EffectTable table, std::vector<std::string> effects);

/// What these parameters say. Throws Failure for what can't be drawn.
Draw read_draw(const Parameters& p, EffectTable table);

/// A record `bench_properties` with `effect` (the names, or none), `size` and `unit` (of the first; 0 and none where there is
/// none), `effects`, `sizes`, `units`, and each property by its own name.
RecordBuilder bench_properties(const std::vector<HiddenEffect>& hidden);

}  // namespace bodeflow::drive
