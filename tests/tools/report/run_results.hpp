#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace bodeflow::test {

/// The "results" of a result.json with one record of every type that the report knows, and one that it does not.
nlohmann::ordered_json results_of_all_types();

/// A frequency response of a resonance with everything that such a record may carry; `outputs` x `inputs`, 40 lines.
nlohmann::ordered_json response_record(int outputs, int inputs);

/// A whole result.json.
nlohmann::ordered_json result_with(const nlohmann::ordered_json& results, const std::string& status = "complete");

/// A text that would run if it were not escaped, in HTML, SVG and CSS.
extern const char* const kHostile;

}  // namespace bodeflow::test
