// Example 2 of the paper: a narrow window of a fourth-order system.

#include <Eigen/Dense>
#include <complex>

#include "catch.hpp"
#include "examples.hpp"
#include "koopmans_levin/solution.hpp"

using namespace bodeflow::koopmans_levin;
using bodeflow::numerics::Random;
using bodeflow::test::Example2;
using bodeflow::test::Records;

namespace {

constexpr int kRuns = 100;

struct Outcome {
  double mean_noise = 0.0;
  double error_of_mean = 0.0;  // rms over the window of |mean G - G| / |G|
  double rms_error = 0.0;      // rms over window and runs of the same
};

Outcome run_window(NoiseMatrix noise_matrix, bool transient) {
  const Example2 system;
  Random random(31);
  const Records clean = system.clean(random, 2000);
  Eigen::VectorXd omega(200);
  for (Eigen::Index k = 0; k < 200; ++k) omega[k] = 2.0 * 3.141592653589793 * static_cast<double>(k) / 2000.0;
  Model truth;
  truth.a = system.a;
  truth.b = system.b;
  const Eigen::ArrayXcd exact = response(truth, omega);
  Eigen::ArrayXcd sum = Eigen::ArrayXcd::Zero(200);
  Outcome o;
  for (int run = 0; run < kRuns; ++run) {
    const Records r = bodeflow::test::noisy(clean, random, system.input_noise, system.ratio);
    const auto s = solve(*factors(*lines_of(r.input, r.output, Band{0, 199}), 4, transient), system.ratio, noise_matrix);
    REQUIRE(s);
    const Eigen::ArrayXcd g = response(*s, omega);
    sum += g / kRuns;
    o.mean_noise += s->noise / kRuns;
    o.rms_error += ((g - exact) / exact).abs2().mean() / kRuns;
  }
  o.rms_error = std::sqrt(o.rms_error);
  o.error_of_mean = std::sqrt(((sum - exact) / exact).abs2().mean());
  return o;
}

}  // namespace

TEST_CASE("koopmans_levin: Example 2 with the exact noise matrix has a mean response within 2 % and the true noise") {
  const Outcome o = run_window(NoiseMatrix::exact, true);
  CAPTURE(o.mean_noise, o.error_of_mean, o.rms_error);
  CHECK(o.error_of_mean < 0.02);
  CHECK(o.mean_noise == Approx(0.0968).margin(0.003));
}

TEST_CASE("koopmans_levin: Example 2 with the identity as printed is 8 % and more off in the mean") {
  const Outcome o = run_window(NoiseMatrix::identity, true);
  CAPTURE(o.mean_noise, o.error_of_mean, o.rms_error);
  CHECK(o.error_of_mean > 0.08);
  CHECK(o.mean_noise < 1e-4);
}

TEST_CASE("koopmans_levin: Example 2 without the transient is biased") {
  const Outcome o = run_window(NoiseMatrix::exact, false);
  CAPTURE(o.mean_noise, o.error_of_mean, o.rms_error);
  CHECK(o.error_of_mean > 0.01);
  CHECK(o.mean_noise > 0.105);  // .0968 +- .0008 with it
}
