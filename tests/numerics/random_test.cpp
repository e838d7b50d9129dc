#include "bodeflow/numerics/random.hpp"

#include <cmath>
#include <vector>

#include "catch.hpp"

using namespace bodeflow::numerics;

namespace {
constexpr int kDeviates = 200000;
}

TEST_CASE("the generator gives the sequence of the published algorithm") {
  // xoshiro256++ and splitmix64 written anew in Python from the authors' reference code, seed 42.
  Random random(42);
  CHECK(random.bits() == 0xd0764d4f4476689fu);
  CHECK(random.bits() == 0x519e4174576f3791u);
  CHECK(random.bits() == 0xfbe07cfb0c24ed8cu);
}

TEST_CASE("the normal quantile inverts the distribution function to rounding") {
  for (const double p : {1e-15, 1e-9, 1e-5, 0.001, 0.02, 0.074, 0.076, 0.2, 0.4999, 0.5, 0.77, 0.93, 0.999}) {
    const double x = normal_quantile(p);
    // Phi(x) = erfc(-x / sqrt 2) / 2; a relative error e of x shows as e x^2 or more in the tails.
    CHECK(std::abs(0.5 * std::erfc(-x / std::sqrt(2.0)) - p) <= 4e-15 * p * std::max(1.0, x * x));
  }
  CHECK(normal_quantile(0.5) == 0.0);
  CHECK(normal_quantile(0.25) == Approx(-0.67448975019608174320).epsilon(1e-15));
  CHECK(normal_quantile(0.975) == Approx(1.95996398454005423552).epsilon(1e-15));
}

TEST_CASE("the portable logarithm agrees with the library's within two units in the last place") {
  for (double x = 1e-300; x < 1e300; x *= 7.3) CHECK(std::abs(portable_log(x) - std::log(x)) <= 4.5e-16 * std::abs(std::log(x)));
  for (double x = 0.5; x < 2; x += 0.00173)
    CHECK(std::abs(portable_log(x) - std::log(x)) <= 4.5e-16 * std::abs(std::log(x)) + 1e-300);
  CHECK(portable_log(1.0) == 0.0);
}

TEST_CASE("normal deviates have the moments, tails and whiteness of a normal distribution") {
  Random random(7);
  std::vector<double> x(kDeviates);
  for (double& value : x) value = random.normal();
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0;
  int beyond_two = 0;
  for (const double value : x) {
    m1 += value / kDeviates;
    m2 += value * value / kDeviates;
    m3 += value * value * value / kDeviates;
    m4 += value * value * value * value / kDeviates;
    if (std::abs(value) > 2) ++beyond_two;
  }
  const double root = std::sqrt(static_cast<double>(kDeviates));
  // Four standard deviations each: 1, sqrt 2, sqrt 15, sqrt 96 over sqrt N; P(|x| > 2) = 0.0455.
  CHECK(std::abs(m1) < 4 / root);
  CHECK(std::abs(m2 - 1) < 4 * std::sqrt(2.0) / root);
  CHECK(std::abs(m3) < 4 * std::sqrt(15.0) / root);
  CHECK(std::abs(m4 - 3) < 4 * std::sqrt(96.0) / root);
  CHECK(std::abs(beyond_two / static_cast<double>(kDeviates) - 0.0455003) < 4 * 0.2084 / root);
  for (int lag = 1; lag <= 20; ++lag) {
    double correlation = 0;
    for (int n = lag; n < kDeviates; ++n)
      correlation += x[static_cast<std::size_t>(n)] * x[static_cast<std::size_t>(n - lag)] / kDeviates;
    CHECK(std::abs(correlation) < 4 / root);
  }
}

TEST_CASE("uniform deviates lie inside (0, 1) and fill it evenly") {
  Random random(3);
  std::vector<int> bins(100);
  for (int n = 0; n < kDeviates; ++n) {
    const double u = random.uniform();
    REQUIRE(u > 0);
    REQUIRE(u < 1);
    ++bins[static_cast<std::size_t>(u * 100)];
  }
  double chi_squared = 0;
  for (const int count : bins) chi_squared += (count - 2000.0) * (count - 2000.0) / 2000.0;
  // 99 degrees of freedom: mean 99, standard deviation 14.1.
  CHECK(chi_squared > 55);
  CHECK(chi_squared < 155);
}

TEST_CASE("streams of one seed differ from each other and from those of its neighbour, and repeat") {
  CHECK(Random::stream(5, 0).bits() == Random::stream(5, 0).bits());
  CHECK(Random::stream(5, 0).bits() != Random::stream(5, 1).bits());
  CHECK(Random::stream(5, 1).bits() != Random::stream(6, 0).bits());
  Random a = Random::stream(5, 0), b = Random::stream(5, 1);
  double correlation = 0;
  for (int n = 0; n < kDeviates; ++n) correlation += a.normal() * b.normal() / kDeviates;
  CHECK(std::abs(correlation) < 4 / std::sqrt(static_cast<double>(kDeviates)));
}
