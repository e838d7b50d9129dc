#include "robustness.hpp"

#include <algorithm>

#include "catch.hpp"

using namespace bodeflow::test;

namespace {

/// Plants first .. last of the battery: limits of boundedness, limit cycles, adaptation and tracking.
void check_battery(std::uint64_t first, std::uint64_t last) {
  int meeting = 0, adapted = 0;
  std::vector<double> ratio;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const Case c = battery_case(seed);
    const Outcome o = outcome_of(c, seed);
    INFO("seed " << seed << ", " << c.kind);
    CHECK(o.finite);
    CHECK(o.largest_output < kLargestOutput);
    CHECK(o.saturated_share <= 0.05);
    if (!c.meets_specification) continue;
    ++meeting;
    adapted += o.adapted ? 1 : 0;
    if (o.adapted) ratio.push_back(o.error / o.known_error);
  }
  REQUIRE(meeting > 0);
  CHECK(adapted >= 0.9 * meeting);
  std::sort(ratio.begin(), ratio.end());
  INFO("median " << ratio[ratio.size() / 2] << ", 95 % "
                 << ratio[static_cast<std::size_t>(0.95 * static_cast<double>(ratio.size()))]);
  CHECK(ratio[ratio.size() / 2] <= 1.5);
  CHECK(ratio[static_cast<std::size_t>(0.95 * static_cast<double>(ratio.size()))] <= 3.0);
}

}  // namespace

TEST_CASE("twenty drawn plants: bounded, no limit cycle, adapted, tracked nearly as by the known plant's controller") {
  check_battery(1, 20);
}

TEST_CASE("six hundred drawn plants: bounded, no limit cycle, adapted, tracked nearly as by the known plant's controller",
          "[long]") {
  const std::uint64_t first = GENERATE(1, 5001, 9001);
  check_battery(first, first + 199);
}

// Of some thousand plants, those that ended in a limit cycle while the watch had no eye on the actuator, or let what swung out
// after a retreat widen its range.
TEST_CASE("plants that a designed controller drove into a limit cycle are taken back from it") {
  for (const std::uint64_t seed : {5058, 20390, 30964, 31084, 31659, 32826, 33219}) {
    const Outcome o = outcome_of(battery_case(seed), seed);
    INFO("seed " << seed);
    CHECK(o.saturated_share <= 0.05);
    CHECK(o.largest_output < kLargestOutput);
  }
}
