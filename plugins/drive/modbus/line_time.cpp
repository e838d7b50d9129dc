#include "line_time.hpp"

#include "register_groups.hpp"

namespace bodeflow::drive::modbus {
namespace {

constexpr double kBits = 11.0;                                       // of a character
constexpr double kShortestSilence = 1.75e-3;                         // s, from 19200 baud on
constexpr int kWriteOne = 8 + 8, kWriteMany = 9 + 8, kRead = 8 + 5;  // characters without values

}  // namespace

double line_time(const RegisterMap& map, const std::vector<std::size_t>& set_points, const std::vector<std::size_t>& read,
                 int baud) {
  int characters = 0, questions = 0;
  for (const RegisterGroup& group : group_registers(map, set_points, kMostWritten)) {
    characters += group.words == 1 ? kWriteOne : kWriteMany + 2 * group.words;
    ++questions;
  }
  if (!set_points.empty()) {
    characters += kWriteOne;  // the controlword
    ++questions;
  }
  for (const RegisterGroup& group : group_registers(map, read, kMostRead)) {
    characters += kRead + 2 * group.words;
    ++questions;
  }
  const double character_s = kBits / baud;
  constexpr int kFastLine = 19200;
  const double silence_s = baud > kFastLine ? kShortestSilence : 3.5 * character_s;
  return characters * character_s + 2 * questions * silence_s;
}

}  // namespace bodeflow::drive::modbus
