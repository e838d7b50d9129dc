#include "sampled_plant.hpp"

#include "catch.hpp"
#include "simulator.hpp"

using namespace bodeflow;
using namespace bodeflow::plants;

namespace {

numerics::StateSpace lag() {
  return *numerics::to_state_space(numerics::TransferFunction{Eigen::VectorXd::Ones(1), Eigen::Vector2d(1, 1)});
}
numerics::StateSpace lead() {
  return *numerics::to_state_space(numerics::TransferFunction{Eigen::Vector2d(1, 2), Eigen::Vector2d(1, 1)});
}

}  // namespace

TEST_CASE("a plant without feed-through waits for one sample, one with feed-through for none") {
  CHECK(*input_delay(lag(), 0.1, 0.0) == 1);
  CHECK(*input_delay(lead(), 0.1, 0.0) == 0);
  CHECK(*input_delay(lag(), 0.1, 0.3) == 4);
  CHECK(*input_delay(lead(), 0.1, 0.3) == 3);
  CHECK(*input_delay(lead(), 0.1, 0.32) == 4);
  CHECK(sampled_plant(lag(), 0.1, 0.0)->late);
  CHECK_FALSE(sampled_plant(lead(), 0.1, 0.0)->late);
  CHECK(sampled_plant(lead(), 0.1, 0.05)->late);
}

TEST_CASE("a discrete-time plant takes whole delays only") {
  numerics::StateSpace model = lag();
  model.sample_time = 1;
  CHECK(*input_delay(model, 0.1, 0.2) == 3);
  CHECK(sampled_plant(model, 0.1, 0.25).error().text ==
        "delay is 0.25 s, allowed for a discrete-time model: a whole number of samples of 0.1 s");
}

TEST_CASE("the simulator's special and general forms give the same bits") {
  // Six states fall to the general form; the same system as a chain of small ones would need other roundings, so two copies side
  // by side are compared with one.
  Eigen::MatrixXd a(2, 2), b(2, 1), c(1, 2), d(1, 1);
  a << 0.9, 0.2, -0.3, 0.7;
  b << 1, 0.5;
  c << 2, -1;
  d << 0.25;
  Eigen::MatrixXd a2 = Eigen::MatrixXd::Zero(4, 4), b2 = Eigen::MatrixXd::Zero(4, 1), c2 = Eigen::MatrixXd::Zero(2, 4), d2(2, 1);
  a2.topLeftCorner(2, 2) = a2.bottomRightCorner(2, 2) = a;
  b2 << b, b;
  c2.topLeftCorner(1, 2) = c2.bottomRightCorner(1, 2) = c;
  d2 << d, d;
  Simulator one(*numerics::make_state_space(a, b, c, d, 1), {0.1, 0.2}, false);
  Simulator two(*numerics::make_state_space(a2, b2, c2, d2, 1), {0.1, 0.2, 0.1, 0.2}, false);
  std::vector<double> u(100), y(100), y0(100), y1(100);
  for (std::size_t n = 0; n < 100; ++n) u[n] = static_cast<double>(n * n % 17) - 8.1;
  const double* in[] = {u.data()};
  double* out_one[] = {y.data()};
  double* out_two[] = {y0.data(), y1.data()};
  one.run(in, out_one, 100);
  two.run(in, out_two, 100);
  CHECK(y0 == y1);
  CHECK(y == y0);
}
