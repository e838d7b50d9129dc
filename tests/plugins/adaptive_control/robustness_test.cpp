#include "robustness.hpp"

#include <algorithm>

#include "catch.hpp"

using namespace bodeflow::test;

namespace {

/// Plants first .. last of the battery: limits of boundedness, limit cycles, adaptation and tracking.
void check_battery(std::uint64_t first, std::uint64_t last, double median_limit, double most_limit) {
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
  CHECK(ratio[ratio.size() / 2] <= median_limit);
  CHECK(ratio[static_cast<std::size_t>(0.95 * static_cast<double>(ratio.size()))] <= most_limit);
}

}  // namespace

TEST_CASE("twenty drawn plants: bounded, no limit cycle, adapted, tracked nearly as by the known plant's controller") {
  check_battery(1, 20, 1.5, 3.0);
}

TEST_CASE("two hundred drawn plants: bounded, no limit cycle, adapted, tracked nearly as by the known plant's controller",
          "[long]") {
  check_battery(1, 200, 1.5, 3.0);
}
