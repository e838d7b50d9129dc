#include "catch.hpp"
#include "simulated.hpp"

using namespace bodeflow;
using namespace bodeflow::test;
using namespace bodeflow::maximum_likelihood;

namespace {

int right_orders(int runs) {
  const Eigen::VectorXd omega = log_spaced(1.0, 100.0, 50);
  const Rational truth = ladder(3, omega, 0.0, 0.0);
  Settings s;
  s.highest_order = 5;
  s.starts = 3;
  int right = 0;
  for (int n = 0; n < runs; ++n) {
    numerics::Random random = numerics::Random::stream(77, static_cast<std::uint64_t>(n));
    const auto id = identify(measured(truth, omega, {0.01, 0.02, 0.0}, random), s);
    REQUIRE(id);
    if (id->fit.structure.order == 3) ++right;
  }
  return right;
}

}  // namespace

TEST_CASE("maximum likelihood: the order is right in 24 of 25 sets or more") { CHECK(right_orders(25) >= 24); }

TEST_CASE("maximum likelihood: the order is right in 95 of 100 sets or more", "[long]") { CHECK(right_orders(100) >= 95); }

TEST_CASE("maximum likelihood: no order costs more than the one below it") {
  const Eigen::VectorXd omega = log_spaced(1.0, 100.0, 50);
  numerics::Random random(5);
  Settings s;
  s.highest_order = 6;
  const auto id = identify(measured(ladder(3, omega, 0.0, 0.0), omega, {0.01, 0.02, 0.0}, random), s);
  REQUIRE(id);
  REQUIRE(id->scan->orders.size() == 6);
  for (std::size_t i = 1; i < 6; ++i) CHECK(id->scan->orders[i].test.cost <= id->scan->orders[i - 1].test.cost * (1.0 + 1e-6));
  const auto& right = id->scan->orders[2];
  CHECK(right.criteria.mdl < id->scan->orders[1].criteria.mdl);
  CHECK(right.criteria.mdl < id->scan->orders[4].criteria.mdl);
  CHECK(id->scan->orders[1].significance < 1e-6);
}
