#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodeflow::tools::exports {

/// A record's bytes as the JSON of result.json.
std::string json_of_record(const std::vector<std::uint8_t>& bytes);

}  // namespace bodeflow::tools::exports
