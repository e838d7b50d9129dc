#include "identity.hpp"

#include <cmath>

#include "register_value.hpp"

namespace bodeflow::drive::modbus {

using numerics::Expected;
using numerics::refused;

Expected<double> read_value(Link& link, const Register& r) {
  std::uint16_t words[2] = {};
  auto read = link.read(r.table, r.address, {words, static_cast<std::size_t>(r.words())});
  if (!read) return tl::make_unexpected(read.error());
  return decoded(r, words);
}

Expected<void> check_identity(Link& link, const RegisterMap& map) {
  for (const auto& [place, wanted] : map.identity) {
    const Register& r = map.registers[place];
    const auto found = read_value(link, r);
    if (!found) return tl::make_unexpected(found.error());
    if (std::abs(*found - wanted) <= std::abs(r.scale) / 2) continue;
    return refused(name_of(link.endpoint()) + ": another device than that of " + map.file + ": " + name_of(r) + " is " +
                   quantity(*found, r) + ", the map says " + quantity(wanted, r));
  }
  return {};
}

}  // namespace bodeflow::drive::modbus
