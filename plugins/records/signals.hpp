#pragma once

#include <bodeflow/facts.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace bodeflow::records {

/// Names and units of some channels, one entry a channel.
struct Signals {
  std::vector<std::string> names;
  std::vector<std::string> units;
};

/// The channels of a stream. A channel without a name of its own is called after the port, with its number where there are
/// several; one without a unit of its own has the stream's.
Signals signals_of(const StreamFacts& facts, const std::string& port);

/// The unit of y/u for each output and input, row-major: outputs x inputs.
std::vector<std::string> response_units(const std::vector<std::string>& output_units,
                                        const std::vector<std::string>& input_units);

/// A number for a message, with so many significant digits.
std::string short_number(double value, int digits = 6);

/// "1 line", "3 lines".
std::string counted(std::int64_t count, const std::string& noun);

}  // namespace bodeflow::records
