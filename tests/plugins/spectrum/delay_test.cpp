#include "spectrum/delay.hpp"

#include <bodeflow/numerics/random.hpp>
#include <cmath>
#include <complex>

#include "catch.hpp"

using namespace bodeflow;
using namespace bodeflow::spectrum;
using Complex = std::complex<double>;

namespace {

constexpr double kTwoPi = 6.283185307179586;

/// Lines first, first + step, ... [Hz] of gain (j omega)^slope exp(-j omega delay).
DelayProblem delayed(double gain, int slope, double delay_s, double first, double step, Eigen::Index lines) {
  DelayProblem p;
  p.slope = slope;
  p.frequency_hz = Eigen::VectorXd::LinSpaced(lines, first, first + step * static_cast<double>(lines - 1));
  p.response.resize(lines);
  for (Eigen::Index k = 0; k < lines; ++k) {
    const double omega = kTwoPi * p.frequency_hz[k];
    p.response[k] = gain * std::pow(Complex(0.0, omega), slope) * std::polar(1.0, -omega * delay_s);
  }
  return p;
}

}  // namespace

TEST_CASE("delay: exact for a delayed gain of either sign, an integrator, and odd lines") {
  for (const double tau : {0.0, 1.7e-3, 12.3456e-3, 60e-3}) {
    for (const double gain : {3.0, -0.2}) {
      for (const int slope : {0, -1, -2, 1}) {
        for (const double step : {1.0, 8.0}) {
          const auto e = delay_of(delayed(gain, slope, tau, 4.0, step, 60));
          REQUIRE(e);
          if (tau > 0.5 / step) continue;
          CHECK(e->delay_s == Approx(tau).margin(1e-12));
          CHECK(e->gain == Approx(gain));
          CHECK(e->relative_error < 1e-9);
        }
      }
    }
  }
}

TEST_CASE("delay: standard deviation and misfit are true") {
  const double tau = 3.2e-3;
  double squares = 0.0, predicted = 0.0, misfit = 0.0, bias = 0.0;
  const int runs = 400;
  for (int run = 0; run < runs; ++run) {
    numerics::Random random = numerics::Random::stream(2, static_cast<std::uint64_t>(run));
    DelayProblem p = delayed(2.0, 0, tau, 5.0, 5.0, 40);
    p.largest_s = 0.02;
    p.variance = Eigen::VectorXd::LinSpaced(40, 0.01, 0.4);
    for (Eigen::Index k = 0; k < 40; ++k)
      p.response[k] += std::sqrt(p.variance[k] / 2.0) * Complex(random.normal(), random.normal());
    const auto e = delay_of(p);
    REQUIRE(e);
    bias += (e->delay_s - tau) / runs;
    squares += std::pow(e->delay_s - tau, 2) / runs;
    predicted += std::pow(e->standard_deviation_s, 2) / runs;
    misfit += e->misfit / runs;
  }
  CHECK(predicted / squares == Approx(1.0).epsilon(0.2));
  CHECK(std::abs(bias) < 3.0 * std::sqrt(predicted / runs));
  CHECK(misfit == Approx(1.0).epsilon(0.05));
}

TEST_CASE("delay: dynamics inside the band show as a misfit, and beyond it as a delay of the time constant") {
  DelayProblem p = delayed(1.0, 0, 2e-3, 1.0, 1.0, 50);
  p.largest_s = 0.05;
  p.variance = Eigen::VectorXd::Constant(50, 1e-6);
  const auto with_lag = [&](double time_constant) {
    DelayProblem q = p;
    for (Eigen::Index k = 0; k < 50; ++k) q.response[k] /= Complex(1.0, kTwoPi * q.frequency_hz[k] * time_constant);
    return *delay_of(q);
  };
  CHECK(with_lag(1.0 / (kTwoPi * 20.0)).misfit > 50.0);
  CHECK(with_lag(1e-4).delay_s == Approx(2.1e-3).epsilon(1e-3));
}

TEST_CASE("delay: a second delay that fits as well is told") {
  // Lines 8 Hz apart: delays 1/8 s apart are the same.
  DelayProblem p = delayed(1.0, 0, 10e-3, 8.0, 8.0, 20);
  p.variance = Eigen::VectorXd::Constant(20, 1e-4);
  p.largest_s = 0.2;
  const auto e = delay_of(p);
  REQUIRE(e);
  CHECK(std::abs(e->rival_s - e->delay_s) == Approx(0.125));
  CHECK(e->rival_excess == Approx(0.0).margin(1e-6));
  p.largest_s = 0.1;
  CHECK(delay_of(p)->delay_s == Approx(10e-3));
  CHECK(delay_of(p)->rival_excess > 1000.0);
}

TEST_CASE("delay: what tells nothing is refused") {
  DelayProblem p = delayed(1.0, 0, 1e-3, 1.0, 1.0, 2);
  CHECK(delay_of(p).error().text == "the band has 2 lines; a delay needs at least 3");
  p = delayed(0.0, 0, 1e-3, 1.0, 1.0, 9);
  CHECK(delay_of(p).error().text == "the response is zero over the whole band");
  p = delayed(1.0, 0, 1e-3, 1.0, 1.0, 1000);
  p.largest_s = 1000.0;
  CHECK(delay_of(p).error().text ==
        "1000 lines and delays up to 1000 s are too many to search; give a smaller band or a smaller largest delay");
}
