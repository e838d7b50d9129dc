#include "bodeflow/numerics/chi_squared.hpp"

#include <cmath>

#include "catch.hpp"

using namespace bodeflow::numerics;

TEST_CASE("chi_squared_tail has the values of tables and of closed forms") {
  CHECK(chi_squared_tail(3.841458820694124, 1) == Approx(0.05).epsilon(1e-12));
  CHECK(chi_squared_tail(30.14352720564616, 19) == Approx(0.05).epsilon(1e-12));
  for (const double x : {0.1, 3.0, 40.0, 900.0}) {  // 2 and 4 degrees of freedom are elementary
    CHECK(chi_squared_tail(x, 2) == Approx(std::exp(-0.5 * x)).epsilon(1e-12));
    CHECK(chi_squared_tail(x, 4) == Approx((1.0 + 0.5 * x) * std::exp(-0.5 * x)).epsilon(1e-12));
  }
  CHECK(chi_squared_tail(-1.0, 3) == 1.0);
  CHECK(chi_squared_tail(1e6, 3) == 0.0);
}

TEST_CASE("chi_squared_limit is the inverse of the tail") {
  for (const double dof : {1.0, 3.5, 92.0}) {
    for (const double p : {1e-9, 0.01, 0.5, 0.99}) {
      CHECK(chi_squared_tail(chi_squared_limit(p, dof), dof) == Approx(p).epsilon(1e-10));
    }
  }
}
