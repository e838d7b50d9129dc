#include "execute/time.hpp"

#include <cstdint>
#include <limits>
#include <random>

#include "catch.hpp"
#include "execute/seed.hpp"

namespace bodeflow::execute {
namespace {

TEST_CASE("time: the first firing at or after a record is exact at rational rates") {
  const Rate third(3, 1), seventh(7, 1);
  for (std::int64_t p = 0; p < 1000; ++p) {
    // m / 7 >= p / 3  <=>  3 m >= 7 p
    const std::int64_t m = first_firing(time_of(p, third), seventh);
    CHECK(3 * m >= 7 * p);
    CHECK(3 * (m - 1) < 7 * p);
  }
}

TEST_CASE("time: firings far into a run are exact where doubles are not") {
  const Rate rate(44100, 1), other(48000, 1);
  const std::int64_t p = (std::int64_t{1} << 52) + 1;
  const __int128 product = static_cast<__int128>(p) * 48000;
  const std::int64_t expected = static_cast<std::int64_t>((product + 44099) / 44100);
  CHECK(first_firing(time_of(p, rate), other) == expected);
  CHECK(first_firing(time_of(std::numeric_limits<std::int64_t>::max(), Rate(1, 1)), Rate(10, 1)) ==
        std::numeric_limits<std::int64_t>::max());
}

TEST_CASE("time: a latency is added without rounding") {
  const Time t = later(time_of(1, Rate(3, 1)), Rate(1, 7));
  CHECK(t.num == 10);
  CHECK(t.den == 21);
  CHECK(later(time_of(7, Rate(2, 1)), Rate(5, 2)) == Time{6, 1});
  CHECK(later(time_of(4, Rate(2, 1)), Rate(0, 1)) == Time{2, 1});
}

TEST_CASE("time: comparison orders as cross-multiplication does") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const auto draw = [&](std::int64_t below) { return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(below)); };
    const std::int64_t range = i % 2 == 0 ? 50 : std::int64_t{1} << 40;
    const Time a = time_of(draw(range), Rate(1 + draw(range), 1)), b = time_of(draw(range), Rate(1 + draw(range), 1));
    const bool less = a.num * b.den < b.num * a.den, more = b.num * a.den < a.num * b.den;
    CHECK((a < b) == less);
    CHECK((b < a) == more);
  }
}

TEST_CASE("seed: the seed of a block depends on its name and on the run's seed, and never changes") {
  CHECK(block_seed(1, "noise") != block_seed(1, "noise2"));
  CHECK(block_seed(1, "noise") != block_seed(2, "noise"));
  CHECK(block_seed(1, "") != 0);
  static_assert(block_seed(1, "noise") == block_seed(1, "noise"));
}

}  // namespace
}  // namespace bodeflow::execute
