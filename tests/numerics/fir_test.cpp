#include "bodeflow/numerics/fir.hpp"

#include "catch.hpp"

using namespace bodeflow::numerics;

TEST_CASE("the Bessel function I0 has its tabulated values") {
  // Abramowitz & Stegun, Handbook of Mathematical Functions, table 9.8 and 9.11: I0(1), I0(5) and I0(10).
  CHECK(bessel_i0(0) == 1.0);
  CHECK(bessel_i0(1) == Approx(1.26606587775200833560).epsilon(1e-15));
  CHECK(bessel_i0(5) == Approx(27.2398718236044468946).epsilon(1e-15));
  CHECK(bessel_i0(10) == Approx(2815.71662846625447147).epsilon(1e-15));
}

TEST_CASE("a Kaiser window is symmetric, 1 in the middle and 1/I0(beta) at its ends") {
  const Eigen::VectorXd w = kaiser_window(11, 7.0);
  CHECK(w[5] == 1.0);
  CHECK(w[0] == Approx(1 / bessel_i0(7.0)));
  CHECK((w - w.reverse()).cwiseAbs().maxCoeff() < 1e-16);
  CHECK(kaiser_window(9, 0.0) == Eigen::VectorXd::Ones(9));
}

TEST_CASE("low-pass filters meet their bands with 2 dB to spare in the design") {
  const double attenuation = GENERATE(40.0, 60.0, 80.0, 100.0);
  const double stop = GENERATE(0.1, 0.25, 0.5, 0.8);
  const LowPass design{0.8 * stop, stop, attenuation + 2};
  const auto half = low_pass_half_length(design);
  REQUIRE(half);
  const Eigen::VectorXd h = low_pass(design, *half);
  CHECK(h.sum() == Approx(1.0).epsilon(1e-15));
  CHECK(h == h.reverse());
  const double bound = std::pow(10.0, -attenuation / 20);
  double pass_worst = 0;
  double stop_worst = 0;
  for (int k = 0; k <= 2000; ++k) {
    const double f = k / 2000.0;
    const double magnitude = std::abs(fir_response(h, f));
    if (f <= design.pass_edge) pass_worst = std::max(pass_worst, std::abs(magnitude - 1));
    if (f >= design.stop_edge) stop_worst = std::max(stop_worst, magnitude);
  }
  CHECK(pass_worst < 2 * bound);  // the ripple itself, and what makes the gain 1 at zero frequency
  CHECK(stop_worst < bound);
}

TEST_CASE("the group delay of a low-pass filter is its half length at every frequency of the pass band") {
  const LowPass design{0.2, 0.3, 60};
  const Eigen::VectorXd h = low_pass(design, 30);
  for (const double f : {0.01, 0.07, 0.19}) {
    const std::complex<double> ahead = std::polar(1.0, 3.141592653589793 * f * 30);
    CHECK(std::abs(std::arg(fir_response(h, f) * ahead)) < 1e-12);
  }
}

TEST_CASE("impossible bands and attenuations are refused") {
  CHECK(low_pass_half_length({0.5, 0.5, 80}).error().text == "the edges of the bands must be 0 < pass < stop <= 1");
  CHECK(low_pass_half_length({0.5, 1.5, 80}).error().text == "the edges of the bands must be 0 < pass < stop <= 1");
  CHECK(low_pass_half_length({0.5, 0.5 + 1e-9, 80}).error().text == "the transition band is too narrow: more than 2^26 taps");
  CHECK(low_pass_half_length({0.5, 0.6, 10}).error().text == "the attenuation must be 21 to 200 dB");
}
