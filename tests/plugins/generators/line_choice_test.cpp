#include "line_choice.hpp"

#include <algorithm>
#include <array>

#include "catch.hpp"

using namespace bodeflow::generators;
using bodeflow::numerics::Random;

TEST_CASE("lines of a range and of a parity") {
  CHECK(*lines_in_range(3, 10, 3, 100) == LineNumbers{3, 6, 9});
  CHECK(*lines_in_range(3, 4, 1 << 28, 10) == LineNumbers{3});
  CHECK(*lines_of_parity({1, 2, 3, 4, 5}, "odd") == LineNumbers{1, 3, 5});
  CHECK(*lines_of_parity({1, 2, 3, 4, 5}, "even") == LineNumbers{2, 4});
  CHECK(*lines_of_parity({1, 2}, "all") == LineNumbers{1, 2});
  CHECK(lines_of_parity({2, 4}, "odd").error().text == "lines.parity odd leaves no line");
}

TEST_CASE("of each group of odd lines exactly one is left out, at any place in it, and an incomplete group stays whole") {
  LineNumbers odd;
  for (std::int64_t k = 1; k <= 4001; k += 2) odd.push_back(k);  // 2001 lines: 500 groups of 4 and one line
  const LineNumbers kept = *without_detection_lines(odd, 4, Random(9));
  CHECK(kept.size() == 1501);
  CHECK(kept.back() == 4001);
  std::array<int, 4> places{};
  for (std::size_t begin = 0; begin < 2000; begin += 4) {
    int missing = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (std::binary_search(kept.begin(), kept.end(), odd[begin + i])) continue;
      ++missing;
      ++places[i];
    }
    REQUIRE(missing == 1);
  }
  // Binomial: mean 125, standard deviation 9.7.
  for (const int count : places) CHECK(std::abs(count - 125) < 40);
  CHECK(*without_detection_lines(odd, 4, Random(9)) == kept);
  CHECK(*without_detection_lines(odd, 4, Random(10)) != kept);
}

TEST_CASE("detection lines among even lines, or in groups that do not fit, are refused") {
  CHECK(without_detection_lines({1, 2, 3}, 2, Random(1)).error().text ==
        "detection lines are left out among odd lines, and line 2 is even; lines.parity: odd takes the odd ones");
  CHECK(without_detection_lines({1, 3, 5}, 4, Random(1)).error().text ==
        "detection.group is 4, allowed: 2 to the number of lines, 3");
  CHECK(without_detection_lines({1, 3, 5}, 1, Random(1)).error().text ==
        "detection.group is 1, allowed: 2 to the number of lines, 3");
}
