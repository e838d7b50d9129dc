#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "report/numbers.hpp"

// Fields of an object of the manifest, which may be damaged: what is not there or of another type is "", NaN, 0.
namespace bodeflow::tools::report {

inline std::string text_in(const nlohmann::ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

inline double number_in(const nlohmann::ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : kNaN;
}

inline std::uint64_t count_in(const nlohmann::ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

}  // namespace bodeflow::tools::report
