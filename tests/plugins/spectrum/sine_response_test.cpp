#include "spectrum/sine_response.hpp"

#include <bodeflow/numerics/confidence.hpp>
#include <bodeflow/numerics/random.hpp>
#include <cmath>

#include "catch.hpp"
#include "spectrum/sine_dwell.hpp"

using namespace bodeflow::spectrum;
using bodeflow::numerics::Random;
using Complex = std::complex<double>;

namespace {

Complex circular(Random& random, double sigma) { return {sigma * random.normal(), sigma * random.normal()}; }

}  // namespace

TEST_CASE("sine response: exact without noise, for each output") {
  const Complex u(0.3, -1.2), g(0.5, 2.0), h(-4.0, 0.1);
  const Eigen::VectorXcd input = Eigen::VectorXcd::Constant(5, u);
  Eigen::MatrixXcd output(5, 2);
  output.col(0).setConstant(g * u);
  output.col(1).setConstant(h * u);
  const auto r = sine_response(input, output).value();
  CHECK(r.windows == 5);
  CHECK(std::abs(r.response[0] - g) < 1e-15);
  CHECK(std::abs(r.response[1] - h) < 4e-15);
  CHECK(r.variance.maxCoeff() < 1e-30);
}

TEST_CASE("sine response: the 95 % circles of 4 windows hold the truth in 95 % of 4000 experiments with noise on both signals") {
  const Complex u(1.0, 1.0), g(0.5, 2.0);
  Random random(1);
  int inside = 0;
  double squares = 0.0, predicted = 0.0;
  for (int run = 0; run < 4000; ++run) {
    Eigen::VectorXcd input(4), output(4);
    for (int p = 0; p < 4; ++p) {
      const Complex common = circular(random, 0.02);  // correlated noise, as in a loop
      input[p] = u + common;
      output[p] = g * u + circular(random, 0.05) + 0.5 * common;
    }
    const auto r = sine_response(input, output).value();
    const double error = std::abs(r.response[0] - g);
    inside += error <= bodeflow::numerics::confidence_radius(r.variance[0], 3, 0.95);
    squares += error * error;
    predicted += r.variance[0];
  }
  CHECK(inside > 0.94 * 4000);
  CHECK(inside < 0.96 * 4000);
  CHECK(predicted / squares == Approx(1.0).epsilon(0.05));
}

TEST_CASE("sine response: one window, a silent input and an overflow are refused") {
  const Eigen::VectorXcd one = Eigen::VectorXcd::Ones(1), two = Eigen::VectorXcd::Ones(2);
  CHECK(sine_response(one, one).error().text == "the variance needs at least 2 windows; found 1");
  CHECK(sine_response(Eigen::VectorXcd::Zero(2), two).error().text == "the input is zero");
  CHECK(sine_response(1e-100 * two, 1e300 * two).error().text == "the values are too large");
}

namespace {

/// Pushes u = cos(theta n) and y = (1 + transient(window)) cos(theta n) for whole windows of 20 samples.
template <class Transient>
void push_windows(SineDwell& dwell, int from, int to, Transient transient, double offset = 0.0) {
  for (int n = 20 * from; n < 20 * to; ++n) {
    const double x = std::cos(0.1 * 3.14159265358979323846 * n);
    CHECK(dwell.push(std::vector<double>{x, offset + (1.0 + transient(n / 20)) * x}) == (n % 20 == 19));
  }
}

SettlingRule repeating(double tolerance) {
  SettlingRule rule;
  rule.kind = SettlingRule::Kind::repeat;
  rule.tolerance = tolerance;
  return rule;
}

}  // namespace

TEST_CASE("sine dwell: the answer has settled from the first window that agrees with all that follow") {
  SineDwell dwell(20, 1, 1, repeating(1e-3));
  const auto halving = [](int window) { return std::pow(0.5, window); };
  push_windows(dwell, 0, 9, halving);
  CHECK(dwell.settled_windows() == 1);  // windows 7 and 8 still differ by 2^-8
  push_windows(dwell, 9, 12, halving);
  CHECK(dwell.windows() == 12);
  CHECK(dwell.settled_from() == 20 * 9);  // 9 and 10 differ by 2^-10
  CHECK(dwell.settled_windows() == 3);
  push_windows(dwell, 12, 14, [](int) { return 0.1; });  // a disturbance starts it again
  CHECK(dwell.settled_windows() == 2);
  CHECK(std::abs(dwell.estimate(2)->response[0] - 1.1) < 1e-12);
}

TEST_CASE("sine dwell: by the envelope the answer has settled within a window, which then does not count") {
  SettlingRule rule;
  rule.noise = {1e-3};
  SineDwell dwell(20, 1, 1, rule);
  push_windows(dwell, 0, 3, [](int) { return 0.0; });
  CHECK(dwell.settled_from() == 0);
  CHECK(dwell.settled_windows() == 3);
  push_windows(dwell, 3, 6, [](int) { return 0.01; });
  // The coefficient turns from 1 to 1.01 in the window that begins after sample 40: within 9.6e-3 sqrt(1/10) = 3.04e-3 of the end
  // value late in it.
  CHECK(dwell.settled_from() > 40);
  CHECK(dwell.settled_from() < 60);
  CHECK(dwell.settled_windows() == 3);
  CHECK(std::abs(dwell.estimate(3)->response[0] - 1.01) < 1e-12);
}

TEST_CASE("sine dwell: an input of another frequency than the one that is measured is refused") {
  SineDwell dwell(20, 1, 1, repeating(1e-3));
  for (int n = 0; n < 100; ++n) dwell.push(std::vector<double>{3.0 + std::cos(0.2 * 3.14159265358979323846 * n), 1.0});
  CHECK(dwell.estimate(4).error().text == "the input does not hold this frequency");
}
