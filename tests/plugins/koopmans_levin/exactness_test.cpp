#include <Eigen/Dense>

#include "../reference_file.hpp"
#include "catch.hpp"
#include "examples.hpp"
#include "koopmans_levin/line_sums.hpp"
#include "koopmans_levin/powers.hpp"
#include "koopmans_levin/solution.hpp"
#include "koopmans_levin/time_domain.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Example2;
using bodeflow::test::Records;
using bodeflow::test::relative_difference;

namespace {

Solution solved(const Lines& lines, Eigen::Index order, double ratio, bool transient = true) {
  const auto s = solve(*factors(lines, order, transient), ratio);
  REQUIRE(s);
  return *s;
}

}  // namespace

TEST_CASE("koopmans_levin: an arbitrary input without noise gives the system to 1e-10 with the transient, and not without it") {
  const Example1 system;
  Random random(1);
  for (const Eigen::Index samples : {40, 251, 1000}) {
    CAPTURE(samples);
    const Records r = system.clean(random, samples);
    for (const auto& band : {std::optional<Band>(), std::optional<Band>(Band{3, samples / 3})}) {
      const auto lines = lines_of(r.input, r.output, band);
      REQUIRE(lines);
      const Solution s = solved(*lines, 2, 6.0);
      CHECK(relative_difference(s.a, system.a) < 1e-10);
      CHECK(relative_difference(s.b, system.b) < 1e-10);
      CHECK(s.noise < 1e-24);
      const Solution without = solved(*lines, 2, 6.0, false);
      CHECK(relative_difference(without.a, system.a) > 1e-4);
    }
  }
}

TEST_CASE("koopmans_levin: a narrow band without noise gives a fourth-order system to 1e-6") {
  const Example2 system;
  Random random(2);
  const Records r = system.clean(random, 2000);
  const auto lines = lines_of(r.input, r.output, Band{0, 199});
  const Solution s = solved(*lines, 4, 6.0);
  CHECK(relative_difference(s.a, system.a) < 1e-6);  // the columns are dependent to 1e-9 in this band
  CHECK(relative_difference(s.b, system.b) < 1e-5);
}

TEST_CASE("koopmans_levin: the noise variance is right down to 1e-8 of the amplitude in a narrow band") {
  const Example2 system;
  Random random(3);
  const Records clean = system.clean(random, 2000);
  const Eigen::VectorXd u = bodeflow::test::white(random, 2000, 0.1), y = bodeflow::test::white(random, 2000, 0.6);
  std::vector<double> scaled;
  for (const double amplitude : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const auto lines = lines_of(clean.input + amplitude * u, clean.output + amplitude * y, Band{0, 199});
    scaled.push_back(solved(*lines, 4, 6.0).noise / (amplitude * amplitude));
  }
  for (const double value : scaled) CHECK(value == Approx(scaled[1]).epsilon(1e-3));
}

TEST_CASE("koopmans_levin: the full range equals the time-domain method to 1e-10 for even and odd lengths and orders") {
  const Example2 system;
  Random random(4);
  for (const Eigen::Index samples : {60, 61, 500, 3001}) {
    const Records r = bodeflow::test::noisy(system.clean(random, samples), random, 0.1, 6.0);
    const auto lines = lines_of(r.input, r.output);
    for (const Eigen::Index order : {1, 2, 4, 7}) {
      CAPTURE(samples, order);
      const Solution f = solved(*lines, order, 6.0);
      const auto t = solve(*time_domain_factors(r.input, r.output, order), 6.0);
      REQUIRE(t);
      CHECK(f.noise == Approx(t->noise).epsilon(1e-10));
      CHECK(f.noise_unbiased == Approx(t->noise_unbiased).epsilon(1e-10));
      CHECK(relative_difference(f.a, t->a) < 1e-10);
      CHECK(relative_difference(f.b, t->b) < 1e-10);
    }
  }
}

TEST_CASE("koopmans_levin: sums over lines give the factors of the QR") {
  const Example1 system;
  Random random(5);
  for (const Eigen::Index samples : {50, 2047, 5000}) {
    const Records r = bodeflow::test::noisy(system.clean(random, samples), random, 0.1, 6.0);
    const auto lines = lines_of(r.input, r.output);
    for (const bool transient : {true, false}) {
      for (const Eigen::Index order : {1, 2, 5}) {
        CAPTURE(samples, transient, order);
        const auto qr = solve(*factors(*lines, order, transient), 6.0);
        const auto sums = factors_from_sums(*lines, order, transient);
        REQUIRE(sums);
        const auto s = solve(*sums, 6.0);
        CHECK(s->noise == Approx(qr->noise).epsilon(1e-11));
        CHECK(relative_difference(s->a, qr->a) < 1e-10);
        CHECK(relative_difference(s->b, qr->b) < 1e-10);
        if (transient) CHECK(relative_difference(s->tau, qr->tau) < 1e-10);
      }
    }
  }
}

TEST_CASE("koopmans_levin: sums over lines are those of the definition") {
  Random random(6);
  const Records r = bodeflow::test::noisy(Example1().clean(random, 3000), random, 0.1, 6.0);
  const auto lines = lines_of(r.input, r.output);
  const Eigen::Index n = 3;
  Eigen::MatrixXd sigma = Eigen::MatrixXd::Zero(3 * n + 2, 3 * n + 2);
  for (Eigen::Index k = 0; k < lines->size(); ++k) {
    const Eigen::VectorXcd z = powers_at(lines->omega(k), n);
    Eigen::RowVectorXcd row(3 * n + 2);
    row << z.tail(n).transpose(), lines->output[k] * z.transpose(), lines->input[k] * z.transpose();
    sigma += lines->weight[k] / 3000.0 * (row.adjoint() * row).real();
  }
  CHECK((line_sums(*lines, n).normal_matrix(true) - sigma).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("koopmans_levin: data without noise fall back from sums to the QR") {
  Random random(7);
  const Example1 system;
  const Records r = system.clean(random, 50'000);
  const auto lines = lines_of(r.input, r.output);
  CHECK(factors_from_sums(*lines, 2).error().text == "the columns of the data are too nearly dependent for sums over lines");
  const auto s = solve(*quick_factors(*lines, 2), 6.0);
  REQUIRE(s);
  CHECK(relative_difference(s->a, system.a) < 1e-10);
}

TEST_CASE("koopmans_levin: a line above half the sampling frequency counts as the conjugate of the one below") {
  Random random(8);
  const Records r = bodeflow::test::noisy(Example1().clean(random, 300), random, 0.1, 6.0);
  const auto below = lines_of(r.input, r.output, Band{20, 100}), above = lines_of(r.input, r.output, Band{200, 280});
  CHECK(below->k == above->k);
  CHECK(below->weight == above->weight);
  const auto across = lines_of(r.input, r.output, Band{140, 180});
  CHECK(across->size() == 31);  // 120 .. 150, of which 140 .. 149 stand twice
  CHECK(across->weight.sum() == 41.0);
  CHECK(across->weight[30] == 1.0);  // 150 is its own mirror
}

TEST_CASE("koopmans_levin: a band in rad/sample holds the lines between its ends") {
  const auto band = band_of(0.0, 0.6252, 2000);
  REQUIRE(band);
  CHECK(band->first == 0);
  CHECK(band->last == 199);
  CHECK(band_of(0.0, 3.141592653589793, 2000)->last == 1000);
  CHECK(band_of(0.001, 0.002, 100).error().text ==
        "no line lies in the band [0.001000, 0.002000] rad/sample: lines are 0.062832 apart");
  CHECK(band_of(0.5, 4.0, 100).error().text == "the band [0.500000, 4.000000] rad/sample is not within 0 .. pi");
}
