#include "frisch/noise_variances.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "catch.hpp"
#include "enumeration.hpp"

using namespace bodeflow::frisch;
using bodeflow::numerics::Random;

namespace {

using Complex = std::complex<double>;

// What adding to the cost by rounding can do: relative to the greatest term of the sum.
double rounding(const PowerSpectra& s) { return 1e-13 * s.uu.dot(s.yy); }

// Spectra with noise x1, x2 exactly: all arcs meet there.
PowerSpectra common_point(Random& random, Eigen::Index lines, double x1, double x2) {
  PowerSpectra s{Eigen::VectorXd(lines), Eigen::VectorXd(lines), Eigen::VectorXcd(lines)};
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double power = std::exp(2.0 * random.normal());
    const Complex g = std::polar(std::exp(random.normal()), 6.28 * random.uniform());
    s.uu[k] = power + x1;
    s.yy[k] = power * std::norm(g) + x2;
    s.yu[k] = g * power;
  }
  return s;
}

PowerSpectra random_spectra(Random& random, Eigen::Index lines, double scatter, double coherence) {
  PowerSpectra s{Eigen::VectorXd(lines), Eigen::VectorXd(lines), Eigen::VectorXcd(lines)};
  for (Eigen::Index k = 0; k < lines; ++k) {
    s.uu[k] = std::exp(scatter * random.normal());
    s.yy[k] = std::exp(scatter * random.normal());
    const double share = 1.0 - coherence * random.uniform();
    s.yu[k] = std::polar(std::sqrt(share * s.uu[k] * s.yy[k]), 6.28 * random.uniform());
  }
  return s;
}

// Arcs that touch in one point and differ in curvature only there; near copies of one line; many arcs on the envelope.
PowerSpectra adversarial(Random& random, int kind, Eigen::Index lines) {
  PowerSpectra s = random_spectra(random, lines, 0.3, 0.3);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(lines);
    double c = std::norm(s.yu[k]);
    switch (kind) {
      case 0:  // equal but for rounding
        s.uu[k] = 2.0 * (1.0 + 1e-15 * random.normal());
        s.yy[k] = 3.0 * (1.0 + 1e-15 * random.normal());
        c = 4.0;
        break;
      case 1: {  // tangents of one circle: h_k touches the concave curve sqrt(1 - x^2) at x = t, so every arc is on the envelope
        const double slope = -t / std::sqrt(1.0 - t * t);
        const double room = 1.5 + 0.3 * random.uniform();  // a_k - t
        c = -slope * room * room;
        s.uu[k] = t + room;
        s.yy[k] = std::sqrt(1.0 - t * t) + c / room;
        break;
      }
      case 2:  // all through one point with one slope, (0.5, 0.5) and -1
        s.uu[k] = 0.5 + 0.1 + 2.0 * random.uniform();
        c = (s.uu[k] - 0.5) * (s.uu[k] - 0.5);
        s.yy[k] = 0.5 + c / (s.uu[k] - 0.5);
        break;
      case 3:  // powers over 12 decades
        s.uu[k] = std::pow(10.0, 12.0 * random.uniform() - 6.0);
        s.yy[k] = std::pow(10.0, 12.0 * random.uniform() - 6.0);
        c = 0.5 * s.uu[k] * s.yy[k];
        break;
      case 4:  // some lines without any correlation
        if (k % 3 == 0) c = 0.0;
        break;
      case 5:  // the second arc, nearly straight, cuts the top of the first one off where its cost is least
        s.uu[k] = k == 0 ? 1.2 : k == 1 ? 20.0 : 10.0 + random.uniform();
        c = k == 0 ? 0.2 : k == 1 ? 370.4 : 1.0;
        s.yy[k] = k == 0 ? 1.0 : k == 1 ? 19.8 - 0.05 * random.uniform() : 10.0 + random.uniform();
        break;
      default:  // nearly no noise
        c = s.uu[k] * s.yy[k] * (1.0 - 1e-9 * random.uniform());
        break;
    }
    s.yu[k] = std::polar(std::sqrt(c), random.uniform());
  }
  return s;
}

void check_walk(const PowerSpectra& s, bool enumerate) {
  const auto noise = noise_variances(s);
  REQUIRE(noise);
  CHECK(noise->input >= 0.0);
  CHECK(noise->output >= 0.0);
  // Feasible: no determinant below zero but for rounding.
  const Eigen::ArrayXd det = determinants(s, *noise);
  CHECK((det > -1e-12 * s.uu.array() * s.yy.array()).all());
  CHECK(noise->cost <= bodeflow::test::least_cost_on_grid(s, 2001) + rounding(s));
  if (enumerate) CHECK(noise->cost == Approx(bodeflow::test::least_cost_by_enumeration(s)).margin(rounding(s)).epsilon(0.0));
}

}  // namespace

TEST_CASE("frisch: spectra with one common point give exactly that point") {
  Random random(1);
  for (const Eigen::Index lines : {2, 5, 24, 300}) {
    const PowerSpectra s = common_point(random, lines, 0.7, 0.02);
    const auto noise = noise_variances(s);
    REQUIRE(noise);
    CHECK(noise->input == Approx(0.7).epsilon(1e-9));
    CHECK(noise->output == Approx(0.02).epsilon(1e-9));
    CHECK(determinants(s, *noise).cwiseAbs().maxCoeff() < 1e-9 * s.uu.cwiseProduct(s.yy).maxCoeff());
  }
}

TEST_CASE("frisch: spectra of one window leave no noise") {
  Random random(2);
  PowerSpectra s = random_spectra(random, 10, 1.0, 0.0);
  const auto noise = noise_variances(s);
  REQUIRE(noise);
  CHECK(noise->input < 1e-12);
  CHECK(noise->output < 1e-12);
}

TEST_CASE("frisch: the walk is never above a grid and equals the enumeration on 700 random instances") {
  Random random(3);
  for (int i = 0; i < 700; ++i) {
    CAPTURE(i);
    const Eigen::Index lines = 2 + static_cast<Eigen::Index>(random.bits() % 24);
    check_walk(random_spectra(random, lines, 0.02 + 1.5 * random.uniform(), random.uniform()), i % 2 == 0);
  }
}

TEST_CASE("frisch: the walk is never above a grid and equals the enumeration on 350 adversarial instances") {
  Random random(4);
  for (int i = 0; i < 350; ++i) {
    CAPTURE(i, i % 7);
    const Eigen::Index lines = 2 + static_cast<Eigen::Index>(random.bits() % 23);
    check_walk(adversarial(random, i % 7, lines), true);
  }
}

TEST_CASE("frisch: every line on the envelope of 2000") {
  Random random(5);
  check_walk(adversarial(random, 1, 2000), false);
}

TEST_CASE("frisch: the second pass leaves out the lines nearest to singular") {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const PowerSpectra s = random_spectra(random, 25, 0.2, 0.3);
    const auto noise = frisch_noise(s);
    REQUIRE(noise);
    REQUIRE(noise->removed.size() == 2);
    const Eigen::VectorXd det = determinants(s, noise->first).cwiseAbs();
    for (Eigen::Index k = 0; k < 25; ++k) {
      const bool is_removed = k == noise->removed[0] || k == noise->removed[1];
      if (!is_removed) CHECK(det[k] >= std::max(det[noise->removed[0]], det[noise->removed[1]]));
    }

    CHECK(bodeflow::test::envelope(s, noise->first.input) == Approx(noise->first.output).margin(1e-12));
  }
  const PowerSpectra s = random_spectra(random, 25, 0.2, 0.3);
  CHECK(frisch_noise(s, 0.0)->removed.empty());
  CHECK(frisch_noise(s, 0.5, OutlierMeasure::relative)->removed.size() == 13);
}
