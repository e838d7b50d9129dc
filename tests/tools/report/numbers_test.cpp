#include "report/numbers.hpp"

#include <cmath>

#include "catch.hpp"
#include "report/polynomial_text.hpp"

using namespace bodeflow::tools::report;

TEST_CASE("report numbers: four digits, powers of ten written out, a dash for what is not finite") {
  CHECK(shown(0.0) == "0");
  CHECK(shown(12.3456) == "12.35");
  CHECK(shown(-2.0) == "−2");
  CHECK(shown(123456.0, 6) == "123456");
  CHECK(shown(1.2345e-5) == "1.234×10⁻⁵");
  CHECK(shown(-3e12) == "−3×10¹²");
  CHECK(shown(0.00999999) == "0.01");
  CHECK(shown(kNaN) == "–");
  CHECK(shown(INFINITY) == "–");
  CHECK(shown(0.5, "rad/A") == "0.5 rad/A");
  CHECK(shown(0.5, "1") == "0.5");
  CHECK(percent(0.123456) == "12.3 %");
  CHECK(counted(1234567) == "1,234,567");
  CHECK(counted(999) == "999");
}

TEST_CASE("report numbers: coordinates have at most one decimal and stay within bounds") {
  CHECK(coordinate(12.0) == "12");
  CHECK(coordinate(12.26) == "12.3");
  CHECK(coordinate(-0.04) == "0");
  CHECK(coordinate(-0.26) == "-0.3");
  CHECK(coordinate(1e300) == "1000000");
  CHECK(coordinate(-INFINITY) == "0");
}

TEST_CASE("report numbers: a phase goes on without jumps, and lines that are not trusted carry nothing on") {
  const std::vector<bool> all(4, true);
  CHECK(unwrapped({170.0, -170.0, -150.0, 10.0}, all) == std::vector<double>{170.0, 190.0, 210.0, 370.0});
  // The third line points anywhere: the fourth follows the second
  CHECK(unwrapped({170.0, -170.0, 0.0, -160.0}, {true, true, false, true}) == std::vector<double>{170.0, 190.0, 360.0, 200.0});
  const auto gap = unwrapped({10.0, kNaN, 20.0}, {true, false, true});
  CHECK(std::isnan(gap[1]));
  CHECK(gap[2] == 20.0);
}

TEST_CASE("report numbers: the median leaves out what is not finite") {
  CHECK(median({3.0, 1.0, 2.0}) == 2.0);
  CHECK(median({4.0, 1.0, kNaN, 2.0, 3.0}) == 2.5);
  CHECK(std::isnan(median({kNaN})));
}

TEST_CASE("report numbers: polynomials are written in descending powers") {
  CHECK(polynomial_text({1.0, -1.2, 0.2}, "z") == "z² − 1.2 z + 0.2");
  CHECK(polynomial_text({-1.0, 0.0, 0.0, 5.0}, "s") == "−s³ + 5");
  CHECK(polynomial_text({-0.5}, "s") == "−0.5");
  CHECK(polynomial_text({0.0, 0.0}, "s") == "0");
  CHECK(polynomial_text({}, "s") == "0");
}
