#pragma once

#include <bodeflow/error.hpp>
#include <bodeflow/parameter_types.hpp>
#include <string_view>

namespace bodeflow::testing {

/// The value of a described parameter from its text: "2.5", "10 kHz", "true", "[1, 2]", "[[1, 2], [3, 4]]" (matrix, or
/// complex pairs), any word or "quoted text". Error: why it is none.
Expected<StoredValue, Error> parse_parameter(const bf_parameter_descriptor& parameter, std::string_view text);

/// The default, or no value.
StoredValue fallback_of(const bf_parameter_descriptor& parameter);

/// A value as the ABI takes it; borrows from the value, which lives unchanged at least as long.
class ValueView {
 public:
  explicit ValueView(const StoredValue& value);
  const bf_parameter_value& c() const { return c_; }

 private:
  std::vector<const char*> strings_;
  bf_parameter_value c_{};
};

}  // namespace bodeflow::testing
