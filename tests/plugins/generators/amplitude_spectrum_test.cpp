#include "amplitude_spectrum.hpp"

#include <cmath>
#include <limits>

#include "catch.hpp"
#include "portable_exp.hpp"

using namespace bodeflow::generators;

namespace {

using List = std::vector<double>;

std::string refusal(const List& frequencies, const List& amplitudes, const List& at = {1.0}) {
  const auto result = amplitudes_on_curve(frequencies, amplitudes, at);
  return result ? "no refusal" : result.error().text;
}

}  // namespace

TEST_CASE("the portable exponential is good to 4 units in the last place") {
  for (int i = -7000; i <= 7000; ++i) {
    const double x = 0.1 * i;
    const auto exact = static_cast<double>(std::exp(static_cast<long double>(x)));
    REQUIRE(std::abs(portable_exp(x) - exact) <= 4 * std::numeric_limits<double>::epsilon() * exact);
  }
  CHECK(portable_exp(0) == 1.0);
}

TEST_CASE("amplitudes lie on straight lines in a doubly logarithmic plot, and on the points themselves") {
  // f^-2 up to 100 Hz, flat up to 1 kHz, one value at the end of the curve.
  const List found = *amplitudes_on_curve(List{1, 100, 1000}, List{4, 4e-4, 4e-4}, List{1, 2, 10, 100, 500, 1000});
  const List expected = {4, 1, 0.04, 4e-4, 4e-4, 4e-4};
  for (std::size_t i = 0; i < found.size(); ++i) CHECK(found[i] == Approx(expected[i]).epsilon(1e-13));
  CHECK(found.front() == 4.0);
  CHECK(found.back() == 4e-4);
}

TEST_CASE("a curve that is none, and lines outside of it, are refused") {
  CHECK(refusal({}, {}) == "spectrum has 0 frequencies and 0 amplitudes; allowed: as many of both, at least one");
  CHECK(refusal({1, 2}, {1}) == "spectrum has 2 frequencies and 1 amplitudes; allowed: as many of both, at least one");
  CHECK(refusal({1, 1}, {1, 1}) == "spectrum.frequencies are not rising and above zero at 1 Hz");
  CHECK(refusal({0, 1}, {1, 1}) == "spectrum.frequencies are not rising and above zero at 0 Hz");
  CHECK(refusal({1, 2}, {1, 0}) == "spectrum.amplitudes are not above zero at 2 Hz");
  CHECK(refusal({1, 2}, {1, 1}, {2.5}) == "a line at 2.5 Hz lies outside of spectrum.frequencies, 1 Hz to 2 Hz");
  CHECK(refusal({1, 2}, {1, 1}, {0.5}) == "a line at 0.5 Hz lies outside of spectrum.frequencies, 1 Hz to 2 Hz");
}
