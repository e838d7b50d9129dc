#include "shift_register.hpp"

#include <array>
#include <bit>

namespace bodeflow::generators {
namespace {

constexpr std::array<std::array<int, 4>, 31> kStages = {
    {{2, 1},        {3, 2},        {4, 3},        {5, 3},        {6, 5},        {7, 6},   {8, 6, 5, 4},     {9, 5},
     {10, 7},       {11, 9},       {12, 6, 4, 1}, {13, 4, 3, 1}, {14, 5, 3, 1}, {15, 14}, {16, 15, 13, 4},  {17, 14},
     {18, 11},      {19, 6, 2, 1}, {20, 17},      {21, 19},      {22, 21},      {23, 18}, {24, 23, 22, 17}, {25, 22},
     {26, 6, 2, 1}, {27, 5, 2, 1}, {28, 25},      {29, 27},      {30, 6, 4, 1}, {31, 28}, {32, 22, 2, 1}}};

std::uint32_t mask(std::span<const int> stages) {
  std::uint32_t taps = 0;
  for (const int stage : stages) taps |= std::uint32_t{1} << (stage - 1);
  return taps;
}

}  // namespace

std::span<const int> feedback_stages(int bits) {
  const std::array<int, 4>& stages = kStages[static_cast<std::size_t>(bits - kLeastBits)];
  return std::span(stages).first(stages[2] == 0 ? 2 : 4);
}

ShiftRegister::ShiftRegister(int bits)
    : taps_(mask(feedback_stages(bits))),
      register_(static_cast<std::uint32_t>((std::uint64_t{1} << bits) - 1)),
      last_(bits - 1) {}

bool ShiftRegister::next() {
  const bool bit = ((register_ >> last_) & 1u) != 0;
  register_ = (register_ << 1) | (static_cast<std::uint32_t>(std::popcount(register_ & taps_)) & 1u);
  return bit;
}

}  // namespace bodeflow::generators
