#pragma once

#include <vector>

#include "register_map.hpp"

namespace bodeflow::drive::modbus {

/// Words in one question, by the protocol.
inline constexpr int kMostRead = 125;
inline constexpr int kMostWritten = 123;

/// Registers that one question covers: neighbours without a gap.
struct RegisterGroup {
  struct Member {
    std::size_t place;  ///< in RegisterMap::registers
    std::size_t index;  ///< in the list that was asked for
    int offset;         ///< of its first word in the group
  };
  Table table = Table::holding;
  int address = 0;
  int words = 0;
  std::vector<Member> members;
};

/// The fewest questions for these registers, ordered by table and address. A gap is never read over: a drive may refuse it.
/// `most`: words in one question.
std::vector<RegisterGroup> group_registers(const RegisterMap& map, const std::vector<std::size_t>& places, int most);

}  // namespace bodeflow::drive::modbus
