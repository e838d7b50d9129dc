#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace bodeflow::tools {

/// Prints the results of a run (the object of result.json) as short tables on standard output: frequency responses at a dozen
/// lines with their standard deviation, every other record by its attributes and the shapes of its arrays. `show`: only the
/// results of these names, in this order; empty: all.
void print_summary(const nlohmann::ordered_json& result, const std::vector<std::string>& show = {});

}  // namespace bodeflow::tools
