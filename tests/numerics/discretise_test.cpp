#include "bodeflow/numerics/discretise.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "bodeflow/numerics/frequency_response.hpp"
#include "catch.hpp"

using namespace bodeflow::numerics;

namespace {

Eigen::VectorXd vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<Eigen::Index>(values.size()));
}

StateSpace system(std::initializer_list<double> numerator, std::initializer_list<double> denominator) {
  return *to_state_space(TransferFunction{vector(numerator), vector(denominator)});
}

// A sequence that excites everything: fractional parts of the golden ratio's multiples.
double input(Eigen::Index n) { return n < 0 ? 0.0 : std::fmod(0.6180339887498949 * static_cast<double>(n + 1), 1.0) - 0.4; }

Eigen::VectorXd simulate(const DelayedModel& m, Eigen::Index samples) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(m.model.states());
  Eigen::VectorXd y(samples);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const Eigen::VectorXd u = Eigen::VectorXd::Constant(1, input(n - m.delay));
    y[n] = (m.model.C * x + m.model.D * u)[0];
    x = m.model.A * x + m.model.B * u;
  }
  return y;
}

// Independent of matrix exponentials: Runge-Kutta of order 4 in long double over the pieces on which the delayed input is
// constant.
using Real = long double;
using LongVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using LongMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

LongVector integrated(const LongMatrix& a, const LongVector& bu, LongVector x, Real time, int steps) {
  const Real h = time / steps;
  for (int k = 0; k < steps; ++k) {
    const LongVector k1 = a * x + bu;
    const LongVector k2 = a * (x + h / 2 * k1) + bu;
    const LongVector k3 = a * (x + h / 2 * k2) + bu;
    const LongVector k4 = a * (x + h * k3) + bu;
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return x;
}

Eigen::VectorXd reference(const StateSpace& ss, double sample_time, double delay, Eigen::Index samples, int steps) {
  const LongMatrix a = ss.A.cast<Real>();
  const LongVector b = ss.B.col(0).cast<Real>();
  const auto whole = static_cast<Eigen::Index>(std::floor(delay / sample_time));
  const Real rest = static_cast<Real>(delay) - static_cast<Real>(whole) * static_cast<Real>(sample_time);
  LongVector x = LongVector::Zero(ss.states());
  Eigen::VectorXd y(samples);
  for (Eigen::Index n = 0; n < samples; ++n) {
    const double at_sample = input(n - whole - (rest > 0 ? 1 : 0));
    y[n] = static_cast<double>((ss.C.cast<Real>() * x)[0]) + ss.D(0, 0) * at_sample;
    if (rest > 0) x = integrated(a, b * static_cast<Real>(input(n - whole - 1)), x, rest, steps);
    x = integrated(a, b * static_cast<Real>(input(n - whole)), x, static_cast<Real>(sample_time) - rest, steps);
  }
  return y;
}

}  // namespace

TEST_CASE("zero-order hold of a first-order lag equals its closed form") {
  const double tau = 0.05, h = 0.01;
  const auto m = zero_order_hold(system({2}, {tau, 1}), h);
  REQUIRE(m);
  CHECK(m->delay == 0);
  CHECK(m->model.sample_time == h);
  CHECK(m->model.A(0, 0) == Approx(std::exp(-h / tau)).epsilon(1e-15));
  CHECK(m->model.C(0, 0) * m->model.B(0, 0) == Approx(-2 * std::expm1(-h / tau)).epsilon(1e-15));
}

TEST_CASE("zero-order hold of an oscillator equals its closed form") {
  const double omega = 30, h = 0.01;
  const auto m = zero_order_hold(system({omega * omega}, {1, 0, omega * omega}), h);
  REQUIRE(m);
  // Astrom & Wittenmark, table 2.1: y(z)/u(z) = (1 - cos wh)(z + 1)/(z^2 - 2 z cos wh + 1)
  CHECK(m->model.A.trace() == Approx(2 * std::cos(omega * h)).epsilon(1e-14));
  CHECK(m->model.A.determinant() == Approx(1.0).epsilon(1e-14));
  const Eigen::MatrixXd first = m->model.C * m->model.B;
  const Eigen::MatrixXd second = m->model.C * m->model.A * m->model.B;
  CHECK(first(0, 0) == Approx(1 - std::cos(omega * h)).epsilon(1e-13));
  CHECK(second(0, 0) == Approx((1 - std::cos(omega * h)) * (1 + 2 * std::cos(omega * h))).epsilon(1e-13));
}

TEST_CASE("zero-order hold of a double integrator is exact to the last bit") {
  const double h = 0.125;
  const auto m = zero_order_hold(system({1}, {1, 0, 0}), h);
  REQUIRE(m);
  Eigen::MatrixXd a(2, 2);
  a << 1, 0, h, 1;
  CHECK(m->model.A == a);
  CHECK(m->model.B == Eigen::Vector2d(h, h * h / 2));
}

TEST_CASE("a delay of a part of a sample gives the closed form of a delayed first-order lag") {
  // dx/dt = -x/T + u(t - tau), Astrom & Wittenmark, example 3.1: Gamma_0 and Gamma_1.
  const double time_constant = 0.02, h = 0.01, tau = 0.0237;  // d = 2, tau' = 0.0037
  const double rest = tau - 2 * h;
  const auto m = zero_order_hold(system({time_constant}, {time_constant, 1}), h, tau);
  REQUIRE(m);
  CHECK(m->delay == 2);
  REQUIRE(m->model.states() == 2);
  CHECK_FALSE(m->model.has_feedthrough());
  const double now = time_constant * (1 - std::exp(-(h - rest) / time_constant));
  const double late = time_constant * std::exp(-(h - rest) / time_constant) * (1 - std::exp(-rest / time_constant));
  CHECK(m->model.C(0, 0) * m->model.B(0, 0) == Approx(now).epsilon(1e-14));
  CHECK(m->model.C(0, 0) * m->model.A(0, 1) == Approx(late).epsilon(1e-14));
  CHECK(m->model.A(0, 0) == Approx(std::exp(-h / time_constant)).epsilon(1e-14));
  CHECK(m->model.B(1, 0) == 1.0);
}

TEST_CASE("the delayed model's steady gain is that of the continuous one, with or without feed-through") {
  for (const double delay : {0.0, 0.004, 0.01, 0.0333}) {
    const auto m = zero_order_hold(system({1, 4, 6}, {1, 2, 3}), 0.01, delay);
    REQUIRE(m);
    CHECK(m->model.has_feedthrough() == (delay == 0.0 || delay == 0.01));
    CHECK(std::abs(frequency_response(m->model, vector({0}))[0](0, 0) - 2.0) < 1e-12);
  }
}

TEST_CASE("a stiff system agrees with fine steps of Runge-Kutta in extended precision") {
  // Poles at -1 and -10000 rad/s, one sample a hundred of the fast time constants long.
  const StateSpace stiff = *to_state_space(
      ZeroPoleGain{vector({-20}).cast<std::complex<double>>(), vector({-1, -1e4}).cast<std::complex<double>>(), 500.0});
  for (const double delay : {0.0, 0.0137}) {
    const auto m = zero_order_hold(stiff, 0.01, delay);
    REQUIRE(m);
    const Eigen::VectorXd expected = reference(stiff, 0.01, delay, 40, 20000);
    CHECK((simulate(*m, 40) - expected).cwiseAbs().maxCoeff() < 1e-12 * expected.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("a system of order 10 with a delay agrees with fine steps of Runge-Kutta in extended precision") {
  ZeroPoleGain zpk;
  zpk.poles.resize(10);
  for (Eigen::Index k = 0; k < 5; ++k) {
    zpk.poles[2 * k] = 12.0 * std::pow(2.0, static_cast<double>(k)) * std::complex<double>(-0.02, 1.0);
    zpk.poles[2 * k + 1] = std::conj(zpk.poles[2 * k]);
  }
  zpk.zeros = vector({-30, 45}).cast<std::complex<double>>();
  zpk.gain = 1e15;
  const auto tf = to_transfer_function(zpk);
  REQUIRE(tf);
  const StateSpace ss = *to_state_space(zpk);
  const auto m = zero_order_hold(ss, 0.01, 0.0255);
  const auto from_polynomials = zero_order_hold(*to_state_space(*tf), 0.01, 0.0255);
  REQUIRE(m);
  REQUIRE(from_polynomials);
  const Eigen::VectorXd expected = reference(ss, 0.01, 0.0255, 200, 400);
  const double scale = expected.cwiseAbs().maxCoeff();
  CHECK((simulate(*m, 200) - expected).cwiseAbs().maxCoeff() < 1e-11 * scale);
  CHECK((simulate(*from_polynomials, 200) - expected).cwiseAbs().maxCoeff() < 1e-10 * scale);
}

TEST_CASE("delays that are a whole number of samples in decimal count as whole") {
  const SplitDelay three = split_delay(0.3, 0.1);
  CHECK(three.samples == 3);
  CHECK(three.rest_s == 0.0);
  const SplitDelay many = split_delay(12345 / 250.0, 1 / 250.0);
  CHECK(many.samples == 12345);
  CHECK(many.rest_s == 0.0);
  const SplitDelay part = split_delay(0.35, 0.1);
  CHECK(part.samples == 3);
  CHECK(part.rest_s == Approx(0.05));
}

TEST_CASE("a gain with a whole delay stays without states, with a part of a sample it remembers one input") {
  const StateSpace gain = *to_state_space(TransferFunction{vector({3}), vector({1})});
  CHECK(zero_order_hold(gain, 0.1, 0.2)->model.states() == 0);
  CHECK(zero_order_hold(gain, 0.1, 0.2)->delay == 2);
  const auto late = zero_order_hold(gain, 0.1, 0.25);
  REQUIRE(late);
  const Eigen::VectorXd y = simulate(*late, 5);
  CHECK(y[2] == 0.0);
  CHECK(y[3] == 3 * input(0));
  CHECK(y[4] == 3 * input(1));
}

TEST_CASE("what cannot be discretised is refused") {
  StateSpace lag = system({1}, {1, 1});
  CHECK(zero_order_hold(lag, 0.0).error().text == "the sample time must be above 0");
  CHECK(zero_order_hold(lag, 0.1, -1.0).error().text == "the delay must not be negative");
  CHECK(zero_order_hold(system({1}, {1, -1e6}), 1.0).error().text ==
        "the system grows beyond the range of a double within one sample");
  lag.sample_time = 0.1;
  CHECK(zero_order_hold(lag, 0.1).error().text == "the system is already a discrete-time one");
}
