#include "drive/sensor_dynamics.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "catch.hpp"

using bodeflow::drive::SensorDynamics;
using Complex = std::complex<double>;

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

std::vector<double> run(double lag, double delay, const std::vector<double>& x) {
  auto made = SensorDynamics::make(lag, delay);
  REQUIRE(made);
  std::vector<double> y(x.size());
  made->run(x, y);
  return y;
}

/// The complex gain of a sine of `frequency` cycles a sample, by least squares over the end of a record in the steady state.
Complex gain(double lag, double delay, double frequency) {
  const std::size_t settle = 100 + static_cast<std::size_t>(delay + 40 * lag), count = 400;
  std::vector<double> x(settle + count);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::cos(kTurn * frequency * static_cast<double>(n));
  const std::vector<double> y = run(lag, delay, x);
  Eigen::MatrixXd waves(count, 2);
  Eigen::VectorXd tail(count);
  for (std::size_t n = 0; n < count; ++n) {
    const double angle = kTurn * frequency * static_cast<double>(settle + n);
    const auto row = static_cast<Eigen::Index>(n);
    waves.row(row) << std::cos(angle), -std::sin(angle);
    tail[row] = y[settle + n];
  }
  const Eigen::VectorXd parts = waves.colPivHouseholderQr().solve(tail);
  return {parts[0], parts[1]};
}

Complex truth(double lag, double delay, double frequency) {
  const Complex s(0, kTurn * frequency);
  return std::exp(-s * delay) / (1.0 + s * lag);
}

}  // namespace

TEST_CASE("sensor dynamics: a sine up to a tenth of the sampling rate comes late by any delay, to 1e-4") {
  for (const double delay : {0.05, 0.3, 0.5, 0.94, 1.0, 1.5, 2.47, 4.1, 37.6}) {
    for (const double frequency : {0.0021, 0.013, 0.04, 0.0777, 0.1}) {
      INFO(delay << " samples at " << frequency);
      const Complex ratio = gain(0, delay, frequency) / truth(0, delay, frequency);
      CHECK(std::abs(std::abs(ratio) - 1) < 1e-4);
      CHECK(std::abs(std::arg(ratio)) < 1e-4);
    }
  }
}

TEST_CASE("sensor dynamics: lag, alone and with a delay, acts on a sine as in continuous time") {
  for (const double lag : {0.02, 0.4, 1.0, 7.0, 60.0}) {
    for (const double delay : {0.0, 0.35, 3.8}) {
      for (const double frequency : {0.0021, 0.013, 0.055, 0.1}) {
        INFO("lag " << lag << ", delay " << delay << " at " << frequency);
        const double error = std::abs(gain(lag, delay, frequency) / truth(lag, delay, frequency) - 1.0);
        CHECK(error < 1e-4);
        if (frequency < 0.01) CHECK(error < 5e-6);
      }
    }
  }
}

TEST_CASE("sensor dynamics: without lag a whole delay moves the samples and keeps their bits") {
  std::vector<double> x;
  for (int n = 0; n < 50; ++n) x.push_back(std::sin(n * n + 0.1));
  CHECK(run(0, 0, x) == x);
  const std::vector<double> late = run(0, 7, x);
  for (std::size_t n = 0; n < x.size(); ++n) CHECK(late[n] == (n < 7 ? 0.0 : x[n - 7]));
}

TEST_CASE("sensor dynamics: constants and ramps are exact once the start is over") {
  std::vector<double> constant(2000, 3.0), ramp(2000);
  for (std::size_t n = 0; n < ramp.size(); ++n) ramp[n] = static_cast<double>(n);
  for (const auto& [lag, delay] : {std::pair{0.0, 0.6}, {3.0, 0.0}, {20.0, 5.25}}) {
    CHECK(run(lag, delay, constant).back() == Approx(3.0).epsilon(1e-12));
    CHECK(run(lag, delay, ramp).back() == Approx(1999.0 - lag - delay).epsilon(1e-11));
  }
}

TEST_CASE("sensor dynamics: a kink of the signal is followed within a quarter of its change of slope") {
  std::vector<double> kinked(60);
  for (std::size_t n = 20; n < kinked.size(); ++n) kinked[n] = static_cast<double>(n) - 20;
  for (int tenth = 0; tenth < 40; ++tenth) {
    const double delay = 0.1 * tenth;
    const std::vector<double> y = run(0, delay, kinked);
    for (std::size_t n = 0; n < y.size(); ++n) {
      CHECK(std::abs(y[n] - std::max(0.0, static_cast<double>(n) - 20 - delay)) < 0.26);
    }
    CHECK(y[40] == Approx(20 - delay).epsilon(1e-12));
  }
}

TEST_CASE("sensor dynamics: what comes out does not depend on how the samples are cut") {
  std::vector<double> x(300), whole(300), pieces(300);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::sin(0.3 * static_cast<double>(n));
  auto first = SensorDynamics::make(2.5, 4.3);
  auto second = first;
  first->run(x, whole);
  for (std::size_t at = 0, length = 1; at < x.size(); at += length, length = 1 + (at * 7) % 23) {
    length = std::min(length, x.size() - at);
    second->run(std::span(x).subspan(at, length), std::span(pieces).subspan(at, length));
  }
  CHECK(whole == pieces);
  second->reset();
  second->run(x, x);
  CHECK(x == whole);
}

TEST_CASE("sensor dynamics: lags and delays that cannot be are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [lag, delay] : {std::pair{-1.0, 0.0}, {0.0, -0.1}, {nan, 0.0}, {0.0, 2e6}})
    CHECK_FALSE(SensorDynamics::make(lag, delay));
  CHECK(SensorDynamics::make(0, 2e6).error().text ==
        "lag of 0.000000 and delay of 2000000.000000 samples; allowed: 0 to 1000000 each");
}
