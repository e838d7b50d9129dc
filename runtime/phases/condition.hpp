#pragma once

#include <tl/expected.hpp>

#include "graph/graph.hpp"
#include "plugins/instance.hpp"

namespace bodeflow::phases {

/// Whether a condition holds for a record. Error: the attribute is absent, or can't be compared with the value.
tl::expected<bool, Problem> holds(const graph::Condition& condition, const SharedRecord& record);

}  // namespace bodeflow::phases
