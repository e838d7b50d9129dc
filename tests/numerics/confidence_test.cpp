#include "bodeflow/numerics/confidence.hpp"

#include <cmath>
#include <limits>

#include "bodeflow/numerics/random.hpp"
#include "catch.hpp"

using namespace bodeflow::numerics;

TEST_CASE("confidence radius: equals the tabulated quantiles of F(2, 2 nu)") {
  // Upper 5 % and 1 % points of F with 2 and 2 nu degrees of freedom, as in the tables of Pearson & Hartley.
  struct Row {
    double nu, at_95, at_99;
  };
  for (const Row& r : {Row{1, 19.00, 99.00}, Row{2, 6.94, 18.00}, Row{3, 5.14, 10.92}, Row{5, 4.10, 7.56}, Row{11, 3.44, 5.72},
                       Row{30, 3.15, 4.98}, Row{60, 3.07, 4.79}}) {
    INFO("nu " << r.nu);
    CHECK(std::pow(confidence_radius(1.0, r.nu, 0.95), 2) == Approx(r.at_95).margin(0.006));
    CHECK(std::pow(confidence_radius(1.0, r.nu, 0.99), 2) == Approx(r.at_99).margin(0.006));
  }
}

TEST_CASE("confidence radius: scales with the standard deviation and has the normal limit") {
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(confidence_radius(4.0, 3.0, 0.95) == Approx(2.0 * confidence_radius(1.0, 3.0, 0.95)).epsilon(1e-14));
  CHECK(confidence_radius(1.0, infinite, 0.95) == Approx(std::sqrt(std::log(20.0))).epsilon(1e-14));
  CHECK(confidence_radius(1.0, 1e12, 0.95) == Approx(std::sqrt(std::log(20.0))).epsilon(1e-11));
  CHECK(confidence_radius(0.0, 3.0, 0.95) == 0.0);
  CHECK(confidence_radius(1.0, 3.0, 0.0) == 0.0);
  CHECK(confidence_radius(1.0, 0.0, 0.95) == infinite);
}

TEST_CASE("confidence radius: the circle around a mean of 4 complex normal values holds the truth as often as it says") {
  Random random(5);
  const int runs = 20000, values = 4;
  for (const double confidence : {0.5, 0.95}) {
    int inside = 0;
    for (int run = 0; run < runs; ++run) {
      double re = 0.0, im = 0.0, squares = 0.0;
      for (int p = 0; p < values; ++p) {
        const double a = random.normal(), b = random.normal();
        re += a / values;
        im += b / values;
        squares += a * a + b * b;
      }
      const double variance = (squares / values - re * re - im * im) / (values - 1);
      inside += std::hypot(re, im) <= confidence_radius(variance, values - 1, confidence) ? 1 : 0;
    }
    const double deviation = std::sqrt(confidence * (1.0 - confidence) / runs);
    CHECK(inside / double(runs) == Approx(confidence).margin(4.0 * deviation));
  }
}
