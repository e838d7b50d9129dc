#include "register_groups.hpp"

#include <algorithm>
#include <tuple>

namespace bodeflow::drive::modbus {

std::vector<RegisterGroup> group_registers(const RegisterMap& map, const std::vector<std::size_t>& places, int most) {
  std::vector<std::size_t> order(places.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto at = [&](std::size_t i) -> const Register& { return map.registers[places[i]]; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(at(a).table, at(a).address) < std::tuple(at(b).table, at(b).address);
  });
  std::vector<RegisterGroup> groups;
  for (const std::size_t i : order) {
    const Register& r = at(i);
    const bool joins = !groups.empty() && groups.back().table == r.table && r.address >= groups.back().address &&
                       r.address <= groups.back().address + groups.back().words &&
                       r.address + r.words() - groups.back().address <= most;
    if (!joins) groups.push_back({r.table, r.address, 0, {}});
    RegisterGroup& group = groups.back();
    const int offset = r.address - group.address;
    group.words = std::max(group.words, offset + r.words());
    group.members.push_back({places[i], i, offset});
  }
  return groups;
}

}  // namespace bodeflow::drive::modbus
