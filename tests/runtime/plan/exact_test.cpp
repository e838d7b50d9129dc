#include "plan/exact.hpp"

#include "catch.hpp"

using namespace bodeflow;
using namespace bodeflow::plan;

TEST_CASE("whole firings of decimal durations are exact where a product of doubles is not") {
  CHECK(whole_firings(Rate::from_hz(8.192), Rate{250, 1}) == 2048);
  CHECK(whole_firings(Rate::from_hz(0.29), Rate{100, 1}) == 29);  // 0.29 * 100 = 28.999999999999996
  CHECK(whole_firings(Rate::from_hz(0.1), Rate{10, 3}) == 0);
  CHECK(whole_firings(Rate::from_hz(0.3), Rate{10, 3}) == 1);
  CHECK(covering_firings(Rate{1, 3}, Rate{10, 1}) == 4);
  CHECK(covering_firings(Rate{2, 5}, Rate{10, 1}) == 4);
}

TEST_CASE("common multiples of periods are exact") {
  CHECK(*common_multiple({1, 250}, {1, 10000}) == Rate{1, 250});
  CHECK(*common_multiple({1, 44100}, {1, 48000}) == Rate{1, 300});
  CHECK(*common_multiple({3, 1000}, {1, 250}) == Rate{3, 250});
  CHECK_FALSE(common_multiple({9007199254740993, 1}, {9007199254740881, 1}));
}

TEST_CASE("division rounds towards minus infinity and upwards") {
  CHECK(floor_divide(-1, 3) == -1);
  CHECK(floor_divide(-3, 3) == -1);
  CHECK(floor_divide(5, 3) == 1);
  CHECK(ceil_divide(-1, 3) == 0);
  CHECK(ceil_divide(4, 3) == 2);
}
