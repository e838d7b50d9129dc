// Exact data give back the system.

#include <bodeflow/numerics/bilinear.hpp>

#include "catch.hpp"
#include "systems.hpp"

using namespace bodeflow;
using namespace bodeflow::subspace;
using test::Complex;

namespace {

/// Order 8 with two inputs and outputs: four modes of rank 1, from 0.3 to 20 rad/s.
numerics::PoleResidue order_8() {
  numerics::Random random(17);
  numerics::PoleResidue system;
  system.poles.resize(4);
  system.D = Eigen::Matrix2d{{0.3, -0.1}, {0.0, 0.5}};
  for (Eigen::Index i = 0; i < 4; ++i) {
    const double omega = 0.3 * std::pow(4.0, static_cast<double>(i));
    system.poles[i] = omega * Complex(-0.03, 1.0);
    Eigen::VectorXcd left(2);
    Eigen::RowVectorXcd right(2);
    for (Complex& x : left) x = Complex(random.normal(), random.normal());
    for (Complex& x : right) x = omega * Complex(random.normal(), random.normal());
    system.residues.emplace_back(left * right);
  }
  return system;
}

}  // namespace

TEST_CASE(
    "a system of order 8 with two inputs and outputs comes back on another grid, whatever the basis and the count of functions") {
  const Lines lines = test::lines_of(order_8(), test::geometric(0.1, 30.0, 60));
  const Eigen::VectorXd other = test::geometric(0.13, 27.0, 173);
  const Eigen::MatrixXcd expected = test::lines_of(order_8(), other).response;
  const Plane plane{bandwidth_prewarp(lines.omega_rad_s), 0.0};
  for (const Basis basis : {Basis::arnoldi, Basis::powers}) {
    for (const Eigen::Index functions : {8, 12, 20, 40}) {
      INFO("functions: " << functions << ", powers: " << (basis == Basis::powers));
      const auto range = range_of(lines, plane, functions, basis);
      REQUIRE(range);
      CHECK(range->singular_values[8] < 1e-13 * range->singular_values[0]);
      const auto model = model_of_order(lines, plane, *range, 8, Stability::project);
      REQUIRE(model);
      CHECK(model->moved == 0);
      CHECK(test::relative(response_of(model->system, other), expected) < 1e-10);
    }
  }
}

TEST_CASE("the order of exact data is seen, and the model with it") {
  const Lines lines = test::lines_of(order_8(), test::geometric(0.1, 30.0, 60));
  const auto found = identify(lines, {bandwidth_prewarp(lines.omega_rad_s), 0.0}, {});
  REQUIRE(found);
  REQUIRE(found->scan);
  CHECK(found->model.order() == 8);
  CHECK(found->scan->rule.find("singular value 8 is") == 0);
  CHECK(found->quality.relative < 1e-10);
}

TEST_CASE("a discrete-time response gives its model of z") {
  const auto continuous = numerics::gilbert_realisation(order_8());
  REQUIRE(continuous);
  const auto z = numerics::bilinear(*continuous, 40.0, 0.05);
  REQUIRE(z);
  const Lines lines = test::lines_of(*z, Eigen::VectorXd::LinSpaced(120, 0.2, 60.0));
  const Plane plane{1.0, 0.05};
  const auto range = range_of(lines, plane, 20, Basis::arnoldi);
  REQUIRE(range);
  const auto model = model_of_order(lines, plane, *range, 8, Stability::project);
  REQUIRE(model);
  CHECK(model->system.sample_time == 0.05);
  CHECK(test::relative(model->response, lines.response) < 1e-10);
  CHECK(test::pole_error(model->poles, z->A.eigenvalues()) < 1e-8);
}

TEST_CASE("weights of relative errors leave exact data exact over eight decades") {
  // A cascade of slow poles: the response falls by eight decades.
  numerics::ZeroPoleGain zpk;
  zpk.poles.resize(4);
  zpk.poles << Complex(-0.02, 1.0), Complex(-0.02, -1.0), -2.0, -5.0;
  zpk.gain = 10.0;
  Lines lines = test::lines_of(*numerics::to_state_space(zpk), test::geometric(0.1, 200.0, 80));
  const Eigen::VectorXd size = lines.response.cwiseAbs();
  REQUIRE(size.maxCoeff() / size.minCoeff() > 1e8);
  lines.weight = relative_weights(lines).value();
  const Plane plane{bandwidth_prewarp(lines.omega_rad_s), 0.0};
  const auto range = range_of(lines, plane, 20, Basis::arnoldi);
  REQUIRE(range);
  const auto model = model_of_order(lines, plane, *range, 4, Stability::project);
  REQUIRE(model);
  CHECK((model->response - lines.response).cwiseAbs().cwiseQuotient(lines.response.cwiseAbs()).maxCoeff() < 1e-9);
}

TEST_CASE("a narrow band far from zero is fitted exactly in the Arnoldi basis") {
  const double giga = 2e9 * std::numbers::pi;
  numerics::PoleResidue system;
  system.poles.resize(3);
  system.D = Eigen::MatrixXd::Constant(1, 1, 0.4);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double omega = giga * (82.0 + 10.0 * static_cast<double>(i));
    system.poles[i] = omega * Complex(-0.01, 1.0);
    system.residues.emplace_back(Eigen::MatrixXcd::Constant(1, 1, 0.01 * omega * Complex(0.3, 1.0)));
  }
  const Lines lines = test::lines_of(system, Eigen::VectorXd::LinSpaced(101, giga * 75.0, giga * 110.0));
  const Plane plane{bandwidth_prewarp(lines.omega_rad_s), 0.0};
  const auto range = range_of(lines, plane, 20, Basis::arnoldi);
  REQUIRE(range);
  const auto model = model_of_order(lines, plane, *range, 6, Stability::project);
  REQUIRE(model);
  CHECK(test::relative(model->response, lines.response) < 1e-9);
}

TEST_CASE("data worked through in blocks give the model of data worked through at once") {
  const Lines lines = test::lines_of(order_8(), test::geometric(0.1, 30.0, 5000));
  const Plane plane{bandwidth_prewarp(lines.omega_rad_s), 0.0};
  const auto at_once = range_of(lines, plane, 20, Basis::arnoldi), in_blocks = range_of(lines, plane, 20, Basis::arnoldi, 1000);
  REQUIRE(at_once);
  REQUIRE(in_blocks);
  CHECK(test::relative(in_blocks->singular_values, at_once->singular_values) < 1e-11);
  const auto model = model_of_order(lines, plane, *in_blocks, 8, Stability::project);
  REQUIRE(model);
  CHECK(test::relative(model->response, lines.response) < 1e-11);
}

TEST_CASE("180 states of example 2 are exact with 200 functions [B3]", "[long]") {
  const Lines lines = test::lines_of(test::example_2(), test::geometric(0.5, 600.0, 1200));
  const Plane plane{bandwidth_prewarp(lines.omega_rad_s), 0.0};
  const auto range = range_of(lines, plane, 200, Basis::arnoldi);
  REQUIRE(range);
  const auto model = model_of_order(lines, plane, *range, 180, Stability::project);
  REQUIRE(model);
  const double error = test::relative(response_of(model->system, lines.omega_rad_s), lines.response);
  INFO("error " << error << ", singular value 181 over 180 " << range->singular_values[180] / range->singular_values[179]);
  CHECK(error <= 1e-11);
  CHECK(model->moved == 0);
}

TEST_CASE("100000 lines with 200 functions are worked through in blocks to exact poles [B4]", "[long]") {
  const Lines lines = test::lines_of(
      [] {
        numerics::PoleResidue one = order_8();
        one.D = one.D.topLeftCorner(1, 1).eval();
        for (auto& M : one.residues) M = M.topLeftCorner(1, 1).eval();
        return one;
      }(),
      test::geometric(0.1, 30.0, 100'000));
  const Plane plane{bandwidth_prewarp(lines.omega_rad_s), 0.0};
  const auto range = range_of(lines, plane, 200, Basis::arnoldi);
  REQUIRE(range);
  const auto model = model_of_order(lines, plane, *range, 8, Stability::project);
  REQUIRE(model);
  CHECK(test::pole_error(model->poles, order_8().poles) < 1e-10);
}
