#include "acquisition/device/device_clock.hpp"

#include "catch.hpp"

using namespace bodeflow::acquisition;

TEST_CASE("device clock: the rate is that of the longest stretch without a gap") {
  DeviceClock clock;
  clock.reset();
  CHECK_FALSE(clock.rate_hz());
  for (int k = 0; k <= 10; ++k) clock.add({100 * k, 5.0 + 0.1 * k});  // 1000 Hz for a second
  CHECK(*clock.rate_hz() == Approx(1000));
  clock.start_anew({5000, 50.0});
  for (int k = 0; k <= 40; ++k) clock.add({5000 + 101 * k, 50.0 + 0.1 * k});  // 1010 Hz for four
  CHECK(*clock.rate_hz() == Approx(1010));
}

TEST_CASE("device clock: stamps stay bounded and span the whole run") {
  DeviceClock clock;
  clock.reset();
  for (int k = 0; k < 20000; ++k) clock.add({k, 0.1 * k});
  CHECK(clock.stamps().size() <= DeviceClock::kMost);
  CHECK(clock.stamps().size() > DeviceClock::kMost / 4);
  CHECK(clock.stamps().front().position == 0);
  CHECK(clock.stamps().back().position > 19000);
}
