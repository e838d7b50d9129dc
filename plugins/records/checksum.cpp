#include "checksum.hpp"

#include <cstdio>
#include <cstring>

namespace bodeflow::records {

void Checksum::add(std::span<const double> values) {
  constexpr std::uint64_t kPrime = 0x100000001b3u;
  for (const double value : values) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int byte = 0; byte < 8; ++byte, bits >>= 8) state_ = (state_ ^ (bits & 0xff)) * kPrime;
  }
}

std::string Checksum::text() const {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(state_));
  return text;
}

}  // namespace bodeflow::records
