#pragma once

#include <bodeflow/numerics/error.hpp>
#include <string>

#include "register_map.hpp"

namespace bodeflow::drive::modbus {

/// The register map that a YAML text states; README.md tells its keys. `file` is the name for messages.
/// Errors: everything that is wrong, a line each, as file:line:column with what was found and what is allowed.
numerics::Expected<RegisterMap> parse_register_map(const std::string& text, const std::string& file);

/// The same for a file. Errors: those, and a file that can't be read or is longer than 1 MiB.
numerics::Expected<RegisterMap> read_register_map(const std::string& path);

}  // namespace bodeflow::drive::modbus
