#pragma once

#include <bodeflow/parameter_text.hpp>

namespace bodeflow::testing {

/// The value of a described parameter from its text, see parse_value. Error: why it is none, with the parameter's name.
Expected<StoredValue, Error> parse_parameter(const bf_parameter_descriptor& parameter, std::string_view text);

/// The default, or no value.
StoredValue fallback_of(const bf_parameter_descriptor& parameter);

using ValueView = BorrowedValue;

}  // namespace bodeflow::testing
