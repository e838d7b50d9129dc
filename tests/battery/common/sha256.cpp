#include "common/sha256.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <vector>

namespace battery {
namespace {

using Words = std::array<std::uint32_t, 64>;

std::array<std::uint32_t, 64> primes() {
  std::array<std::uint32_t, 64> found{};
  std::size_t count = 0;
  for (std::uint32_t n = 2; count < found.size(); ++n) {
    bool prime = true;
    for (std::uint32_t d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
    if (prime) found[count++] = n;
  }
  return found;
}

/// The first 32 bits of the fraction of a root of a prime: the standard's constants. Exact: a long double has 64 bits.
std::uint32_t fraction(long double root) { return static_cast<std::uint32_t>((root - std::floor(root)) * 4294967296.0L); }

struct Constants {
  std::array<std::uint32_t, 8> start{};
  Words round{};
  Constants() {
    const auto p = primes();
    for (std::size_t n = 0; n < 8; ++n) start[n] = fraction(std::sqrt(static_cast<long double>(p[n])));
    for (std::size_t n = 0; n < 64; ++n) round[n] = fraction(std::cbrt(static_cast<long double>(p[n])));
  }
};

const Constants& constants() {
  static const Constants c;
  return c;
}

void take_block(std::array<std::uint32_t, 8>& h, const std::uint8_t* block) {
  Words w{};
  for (std::size_t n = 0; n < 16; ++n) {
    for (std::size_t b = 0; b < 4; ++b) w[n] = (w[n] << 8) | block[4 * n + b];
  }
  for (std::size_t n = 16; n < 64; ++n) {
    const std::uint32_t a = w[n - 15], b = w[n - 2];
    w[n] = w[n - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ (a >> 3)) + w[n - 7] +
           (std::rotr(b, 17) ^ std::rotr(b, 19) ^ (b >> 10));
  }
  auto s = h;
  for (std::size_t n = 0; n < 64; ++n) {
    const std::uint32_t big1 = std::rotr(s[4], 6) ^ std::rotr(s[4], 11) ^ std::rotr(s[4], 25);
    const std::uint32_t t1 = s[7] + big1 + ((s[4] & s[5]) ^ (~s[4] & s[6])) + constants().round[n] + w[n];
    const std::uint32_t big0 = std::rotr(s[0], 2) ^ std::rotr(s[0], 13) ^ std::rotr(s[0], 22);
    const std::uint32_t t2 = big0 + ((s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]));
    s = {t1 + t2, s[0], s[1], s[2], s[3] + t1, s[4], s[5], s[6]};
  }
  for (std::size_t n = 0; n < 8; ++n) h[n] += s[n];
}

}  // namespace

std::array<std::uint8_t, 32> sha256(std::string_view bytes) {
  std::vector<std::uint8_t> message(bytes.begin(), bytes.end());
  const std::uint64_t bits = static_cast<std::uint64_t>(bytes.size()) * 8;
  message.push_back(0x80);
  while (message.size() % 64 != 56) message.push_back(0);
  for (int shift = 56; shift >= 0; shift -= 8) message.push_back(static_cast<std::uint8_t>(bits >> shift));
  auto h = constants().start;
  for (std::size_t n = 0; n < message.size(); n += 64) take_block(h, message.data() + n);
  std::array<std::uint8_t, 32> digest{};
  for (std::size_t n = 0; n < 32; ++n) digest[n] = static_cast<std::uint8_t>(h[n / 4] >> (24 - 8 * (n % 4)));
  return digest;
}

std::string sha256_hex(std::string_view bytes) {
  std::string text;
  for (const std::uint8_t byte : sha256(bytes)) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

}  // namespace battery
