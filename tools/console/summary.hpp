#pragma once

#include <nlohmann/json.hpp>

namespace bodeflow::tools {

/// Prints the results of a run (the object of result.json) as short tables on standard output: frequency responses at a dozen
/// lines with their standard deviation, every other record by its attributes and the shapes of its arrays.
void print_summary(const nlohmann::ordered_json& result);

}  // namespace bodeflow::tools
