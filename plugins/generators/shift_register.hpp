#pragma once

#include <cstdint>
#include <span>

namespace bodeflow::generators {

inline constexpr int kLeastBits = 2, kMostBits = 32;

/// The stages t of a register of `bits` stages (2 .. 32), the last of them first, for x[n] = xor of all x[n - t] to have the
/// longest period, 2^bits - 1. Source: P. Alfke, "Efficient shift registers, LFSR counters, and long pseudo-random sequence
/// generators", Xilinx application note XAPP 052, 1996, table 3. That each polynomial is primitive is tested, not believed.
std::span<const int> feedback_stages(int bits);

/// A binary sequence of maximal length. It begins with the register full of ones.
class ShiftRegister {
 public:
  explicit ShiftRegister(int bits);

  /// The next bit.
  bool next();

 private:
  std::uint32_t taps_, register_;
  int last_;
};

}  // namespace bodeflow::generators
