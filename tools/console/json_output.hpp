#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace bodeflow::tools {

/// Prints JSON on standard output. Bytes that are no UTF-8 (names from data files) become U+FFFD.
template <class Json>
void print_json(const Json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace bodeflow::tools
