#include "parameter_text.hpp"

namespace bodeflow::testing {

Expected<StoredValue, Error> parse_parameter(const bf_parameter_descriptor& parameter, std::string_view text) {
  auto value = parse_value(parameter.type, parameter.unit, text);
  if (!value) return unexpected(std::string("parameter '") + parameter.name + "': " + value.error().text);
  return value;
}

StoredValue fallback_of(const bf_parameter_descriptor& parameter) {
  StoredValue value;
  value.assign(parameter.fallback);
  value.type = parameter.type;
  value.given = false;
  return value;
}

}  // namespace bodeflow::testing
