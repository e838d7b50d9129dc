#include "dynamics.hpp"

#include <cmath>
#include <numbers>

#include "catch.hpp"

using bodeflow::plants::Dynamics;
using bodeflow::plants::dynamics_of;

namespace {

bodeflow::numerics::StateSpace model(const Eigen::MatrixXd& A) {
  const Eigen::Index n = A.rows();
  return {A, Eigen::MatrixXd::Ones(n, 1), Eigen::MatrixXd::Ones(1, n), Eigen::MatrixXd::Zero(1, 1)};
}

}  // namespace

TEST_CASE("dynamics: a resonance is one mode, the slowest pole sets the settling time") {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A.topLeftCorner(2, 2) << 0.0, 1.0, -100.0, -0.4;  // w0 = 10 rad/s, real part -0.2
  A(2, 2) = -50.0;
  const Dynamics d = dynamics_of(model(A));
  REQUIRE(d.modes_hz.size() == 2);
  CHECK(d.modes_hz[0] == Approx(10 / (2 * std::numbers::pi)));
  CHECK(d.modes_hz[1] == Approx(50 / (2 * std::numbers::pi)));
  CHECK(d.settling_s == Approx(25.0));
}

TEST_CASE("dynamics: an integrator never settles and is no mode") {
  const Dynamics d = dynamics_of(model(Eigen::MatrixXd::Zero(1, 1)));
  CHECK(d.modes_hz.empty());
  CHECK(std::isinf(d.settling_s));
}

TEST_CASE("dynamics: a pure gain settles at once") {
  const Dynamics d = dynamics_of(model(Eigen::MatrixXd(0, 0)));
  CHECK(d.modes_hz.empty());
  CHECK(d.settling_s == 0.0);
}
