#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/record.hpp>
#include <nlohmann/json_fwd.hpp>

namespace bodeflow::acquisition {

/// The record that an entry of a result.json stands for. Errors, by attribute or array: whatever no record can hold.
Expected<RecordBuilder> record_of_json(const nlohmann::ordered_json& json);

}  // namespace bodeflow::acquisition
