#include "koopmans_levin/poles.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "catch.hpp"
#include "examples.hpp"
#include "koopmans_levin/influence.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example1;
using bodeflow::test::Records;
using Complex = std::complex<double>;

TEST_CASE("koopmans_levin: poles of a sampled system come back in rad/s and Hz") {
  const double sample_time = 0.002;
  const Complex s(-30.0, 400.0);
  const Complex z = std::exp(s * sample_time);
  Model m;
  m.a = Eigen::Vector3d(1.0, -2.0 * z.real(), std::norm(z));
  m.b = Eigen::Vector3d::Ones();
  const auto found = poles(m, Eigen::MatrixXd::Zero(2, 2), sample_time);
  REQUIRE(found);
  REQUIRE(found->size() == 2);
  for (const Pole& p : *found) {
    CHECK(p.s_rad_s.real() == Approx(-30.0).epsilon(1e-10));
    CHECK(std::abs(p.s_rad_s.imag()) == Approx(400.0).epsilon(1e-10));
    CHECK(p.frequency_hz == Approx(std::abs(s) / (2.0 * 3.141592653589793)).epsilon(1e-10));
    CHECK(p.damping_ratio == Approx(30.0 / std::abs(s)).epsilon(1e-10));
    CHECK(p.real_std_rad_s == 0.0);
  }
}

TEST_CASE("koopmans_levin: poles scatter as their standard deviations say") {
  const Example1 system;
  Random random(101);
  constexpr int kRuns = 200;
  const Records clean = system.clean(random, 2000);
  double re = 0.0, im = 0.0, re_predicted = 0.0, im_predicted = 0.0;
  const Complex truth = std::log(Complex(0.25, std::sqrt(0.3 - 0.0625))) / 0.01;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const auto lines = lines_of(r.input, r.output);
    const auto f = factors(*lines, 2);
    const auto s = solve(*f, system.ratio);
    const auto found = poles(*s, *covariance(*lines, *f, *s), 0.01);
    REQUIRE(found);
    for (const Pole& p : *found) {
      if (p.s_rad_s.imag() <= 0.0) continue;
      re += std::pow(p.s_rad_s.real() - truth.real(), 2);
      im += std::pow(p.s_rad_s.imag() - truth.imag(), 2);
      re_predicted += p.real_std_rad_s * p.real_std_rad_s;
      im_predicted += p.imaginary_std_rad_s * p.imaginary_std_rad_s;
    }
  }
  CAPTURE(re, re_predicted, im, im_predicted);
  CHECK(re / re_predicted == Approx(1.0).margin(0.4));
  CHECK(im / im_predicted == Approx(1.0).margin(0.4));
}

TEST_CASE("koopmans_levin: poles need a sample time and a covariance") {
  Model m;
  m.a = Eigen::Vector2d(1.0, -0.5);
  m.b = Eigen::Vector2d::Ones();
  CHECK(poles(m, Eigen::MatrixXd::Zero(1, 1), 0.0).error().text == "the sample time must be above 0 s and finite");
  CHECK(poles(m, Eigen::MatrixXd(), 1.0).error().text == "the covariance must be at least 1 x 1");
}
