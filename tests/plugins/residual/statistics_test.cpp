#include "statistics.hpp"

#include <bodeflow/numerics/chi_squared.hpp>
#include <limits>

#include "catch.hpp"

using namespace bodeflow::residual;

TEST_CASE("F distribution: tails agree with tables, limits invert them") {
  // 5 % and 1 % points of F(5, 10) and F(30, 60), Abramowitz & Stegun table 26.9.
  CHECK(f_tail(3.33, 5, 10) == Approx(0.05).margin(2e-4));
  CHECK(f_tail(5.64, 5, 10) == Approx(0.01).margin(5e-5));
  CHECK(f_tail(1.65, 30, 60) == Approx(0.05).margin(8e-4));
  CHECK(f_tail(2.03, 30, 60) == Approx(0.01).margin(2e-4));
  for (const double p : {1e-6, 1e-3, 0.3, 0.999, 1 - 1e-4})
    CHECK(f_tail(f_limit(p, 80, 300), 80, 300) == Approx(p).epsilon(1e-9));
}

TEST_CASE("F distribution: with a known denominator it is chi-squared") {
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(f_tail(1.3, 40, infinite) == bodeflow::numerics::chi_squared_tail(52, 40));
  CHECK(f_limit(0.01, 40, infinite) == Approx(bodeflow::numerics::chi_squared_limit(0.01, 40) / 40));
  CHECK(f_tail(1.3, 40, 1e8) == Approx(f_tail(1.3, 40, infinite)).epsilon(1e-5));
  CHECK(f_tail(0, 3, 4) == 1.0);
  CHECK(f_tail(infinite, 3, 4) == 0.0);
}
