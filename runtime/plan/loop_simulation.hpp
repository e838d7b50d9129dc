#pragma once

#include "plan/loop_model.hpp"

namespace bodeflow::plan {

/// One period of a loop by simulating the samples on its edges: each block in turn fires as often at once as they allow.
/// Errors: what is missing where, after lending the loop the missing samples until it runs through.
tl::expected<std::vector<Firing>, Problems> simulate_period(const graph::Phase& phase, LoopModel model);

}  // namespace bodeflow::plan
