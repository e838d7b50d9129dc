#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace bodeflow::record {

/// JSON for files that people read too: a line for each key, arrays without objects on one line, the shortest decimal that
/// reads back as the same double (always with a point or an exponent, so that it stays a floating-point number), null for
/// non-finite values. Invalid UTF-8 is replaced.
std::string json_text(const nlohmann::ordered_json& json);

/// The same on one line, for line files.
std::string json_line(const nlohmann::ordered_json& json);

}  // namespace bodeflow::record
