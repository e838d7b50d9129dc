#include "generate/random.hpp"

#include <bit>
#include <cmath>

#include "common/sha256.hpp"

namespace battery {

Random::Random(std::string_view seed) {
  const auto digest = sha256(seed);
  for (std::size_t n = 0; n < digest.size(); ++n) state_[n / 8] = (state_[n / 8] << 8) | digest[n];
}

std::uint64_t Random::bits() {
  auto& s = state_;
  const std::uint64_t result = std::rotl(s[0] + s[3], 23) + s[0], t = s[1] << 17;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = std::rotl(s[3], 45);
  return result;
}

double Random::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double Random::log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }

double Random::normal() {
  for (;;) {
    const double a = uniform(-1.0, 1.0), b = uniform(-1.0, 1.0), r2 = a * a + b * b;
    if (r2 > 0.0 && r2 < 1.0) return a * std::sqrt(-2.0 * std::log(r2) / r2);
  }
}

}  // namespace battery
