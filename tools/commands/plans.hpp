#pragma once

#include "phases/prepare.hpp"

namespace bodeflow::tools {

/// Says the warnings of all phases, and those that their blocks give, on standard error.
void say_warnings(const std::vector<phases::Prepared>& prepared);

/// Prints the plan of every phase on standard output.
void print_plans(const graph::Graph& graph, const std::vector<phases::Prepared>& prepared, bool as_json);

}  // namespace bodeflow::tools
