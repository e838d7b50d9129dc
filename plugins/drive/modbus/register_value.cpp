#include "register_value.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "records/signals.hpp"

namespace bodeflow::drive::modbus {
namespace {

using numerics::Expected;
using numerics::refused;
using records::short_number;

struct Range {
  double least, greatest;
};

Range range_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::int16:
      return {-32768.0, 32767.0};
    case Encoding::uint16:
      return {0.0, 65535.0};
    case Encoding::int32:
      return {-2147483648.0, 2147483647.0};
    case Encoding::uint32:
      return {0.0, 4294967295.0};
    case Encoding::float32:
      break;
  }
  constexpr double kMost = std::numeric_limits<float>::max();
  return {-kMost, kMost};
}

std::uint32_t bits_of(Encoding encoding, double raw) {
  if (encoding == Encoding::float32) {
    const auto number = static_cast<float>(raw);
    std::uint32_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    return bits;
  }
  return static_cast<std::uint32_t>(std::llround(raw));
}

}  // namespace

std::string quantity(double value, const Register& r) { return short_number(value) + (r.unit == "1" ? "" : " " + r.unit); }

double decoded(const Register& r, const std::uint16_t* words) {
  if (r.encoding == Encoding::uint16) return r.scale * words[0];
  if (r.encoding == Encoding::int16) return r.scale * static_cast<std::int16_t>(words[0]);
  const bool high_first = r.order == WordOrder::high_first;
  const auto bits = static_cast<std::uint32_t>(words[high_first ? 0 : 1]) << 16U | words[high_first ? 1 : 0];
  if (r.encoding == Encoding::uint32) return r.scale * bits;
  if (r.encoding == Encoding::int32) return r.scale * static_cast<std::int32_t>(bits);
  float number = 0.0F;
  std::memcpy(&number, &bits, sizeof number);
  return r.scale * static_cast<double>(number);
}

Expected<std::array<std::uint16_t, 2>> encoded(const Register& r, double value) {
  if (!std::isfinite(value)) return refused(name_of(r) + " is to be " + short_number(value) + ", allowed: finite numbers");
  const double exact = value / r.scale;
  const double raw = r.encoding == Encoding::float32 ? exact : std::round(exact);
  const auto [least, greatest] = range_of(r.encoding);
  if (!(raw >= least && raw <= greatest)) {
    const double first = least * r.scale, last = greatest * r.scale;
    return refused(name_of(r) + " is to be " + quantity(value, r) + ", allowed as " + name_of(r.encoding) + ": " +
                   short_number(std::min(first, last)) + " to " + quantity(std::max(first, last), r));
  }
  const std::uint32_t bits = bits_of(r.encoding, raw);
  const auto high = static_cast<std::uint16_t>(bits >> 16U), low = static_cast<std::uint16_t>(bits & 0xFFFFU);
  if (r.words() == 1) return std::array<std::uint16_t, 2>{low, 0};
  if (r.order == WordOrder::high_first) return std::array<std::uint16_t, 2>{high, low};
  return std::array<std::uint16_t, 2>{low, high};
}

double watchdog_value(const Register& r, double seconds) {
  return r.unit == "ms" ? seconds * 1e3 : r.unit == "us" ? seconds * 1e6 : seconds;
}

}  // namespace bodeflow::drive::modbus
