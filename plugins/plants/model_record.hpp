#pragma once

#include <bodeflow/numerics/linear_system.hpp>
#include <bodeflow/record.hpp>
#include <string>
#include <vector>

namespace bodeflow::plants {

/// The record `model` of a system that is known, by the block of that id. Names and units: one an input or output; empty: "u",
/// "y", numbered where there are several.
RecordBuilder known_model(const std::string& method, const numerics::StateSpace& system, std::vector<std::string> inputs = {},
                          std::vector<std::string> outputs = {}, std::vector<std::string> input_units = {},
                          std::vector<std::string> output_units = {});

}  // namespace bodeflow::plants
