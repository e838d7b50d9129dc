#pragma once

#include <string>
#include <vector>

namespace bodeflow::records {

/// The unit of a ratio: "rad/A"; "rad" and "1/A" where one of them is without unit, "1" where they are equal.
std::string ratio_unit(const std::string& above, const std::string& below);

/// The square of a unit: "rad^2", "(rad/A)^2".
std::string squared_unit(const std::string& unit);

/// The unit that all have, or "" where they differ.
std::string common_unit(const std::vector<std::string>& units);

}  // namespace bodeflow::records
