#include "plan/balance.hpp"

#include "catch.hpp"

using namespace bodeflow::plan;

TEST_CASE("balance: a chain with rate changes has the smallest whole repetitions") {
  const auto solved = balance(4, {{0, 1, 1, 1}, {1, 2, 40, 1}, {2, 3, 3, 64}});
  REQUIRE(solved);
  CHECK(solved->repetitions == std::vector<std::int64_t>{8, 8, 320, 15});
  CHECK(solved->part == std::vector<int>{0, 0, 0, 0});
}

TEST_CASE("balance: the classic CD to DAT chain needs 147 : 160") {
  const auto solved = balance(6, {{0, 1, 1, 1}, {1, 2, 2, 3}, {2, 3, 2, 7}, {3, 4, 8, 7}, {4, 5, 5, 1}});
  REQUIRE(solved);
  CHECK(solved->repetitions == std::vector<std::int64_t>{147, 147, 98, 28, 32, 160});
}

TEST_CASE("balance: unconnected parts are solved apart, single nodes fire once") {
  const auto solved = balance(5, {{0, 3, 2, 3}, {1, 4, 5, 1}});
  REQUIRE(solved);
  CHECK(solved->repetitions == std::vector<std::int64_t>{3, 1, 1, 2, 5});
  CHECK(solved->part == std::vector<int>{0, 1, 2, 0, 1});
}

TEST_CASE("balance: a loop that multiplies has no solution, and the edge that contradicts is named") {
  const auto solved = balance(3, {{0, 1, 2, 1}, {1, 2, 1, 1}, {2, 0, 1, 1}});
  REQUIRE_FALSE(solved);
  CHECK(solved.error().edge == 1);
  CHECK_FALSE(solved.error().overflow);
}

TEST_CASE("balance: two paths of different gain have no solution") {
  const auto solved = balance(3, {{0, 1, 1, 1}, {0, 2, 2, 1}, {1, 2, 1, 1}});
  REQUIRE_FALSE(solved);
  CHECK(solved.error().edge == 2);
}

TEST_CASE("balance: numbers beyond 64 bits are an overflow, not a wrong answer") {
  std::vector<BalanceEdge> edges;
  for (int i = 0; i < 8; ++i) edges.push_back({i, i + 1, 2147483629, 2147483647});
  const auto solved = balance(9, edges);
  REQUIRE_FALSE(solved);
  CHECK(solved.error().overflow);
}
