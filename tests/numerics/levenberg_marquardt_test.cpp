#include "bodeflow/numerics/levenberg_marquardt.hpp"

#include <cmath>
#include <limits>

#include "bodeflow/numerics/random.hpp"
#include "catch.hpp"

using namespace bodeflow::numerics;

namespace {

// y = p0 exp(-p1 t) at `times`.
LeastSquaresProblem decay(const Eigen::VectorXd& times, const Eigen::VectorXd& y) {
  LeastSquaresProblem problem;
  problem.residuals = times.size();
  problem.residual = [=](const Eigen::VectorXd& p, Eigen::VectorXd& r) { r = p[0] * (-p[1] * times.array()).exp() - y.array(); };
  problem.jacobian = [=](const Eigen::VectorXd& p, Eigen::MatrixXd& j) {
    j.col(0) = (-p[1] * times.array()).exp();
    j.col(1) = -p[0] * times.array() * (-p[1] * times.array()).exp();
  };
  return problem;
}

}  // namespace

TEST_CASE("levenberg_marquardt finds the minimum of Rosenbrock's valley from its usual start") {
  LeastSquaresProblem problem;
  problem.residuals = 2;
  problem.residual = [](const Eigen::VectorXd& p, Eigen::VectorXd& r) { r << 10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0]; };
  problem.jacobian = [](const Eigen::VectorXd& p, Eigen::MatrixXd& j) { j << -20.0 * p[0], 10.0, -1.0, 0.0; };
  const auto fit = levenberg_marquardt(problem, Eigen::Vector2d(-1.2, 1.0));
  REQUIRE(fit);
  CHECK(fit->converged);
  CHECK((fit->parameters - Eigen::Vector2d(1.0, 1.0)).norm() < 1e-12);
  CHECK(fit->cost < 1e-24);
}

TEST_CASE("levenberg_marquardt: parameters scatter as the inverse normal matrix says") {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(50, 0.0, 3.0);
  const Eigen::Vector2d truth(2.0, 0.7);
  const Eigen::VectorXd clean = truth[0] * (-truth[1] * times.array()).exp();
  Random random(1);
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::MatrixXd predicted;
  constexpr int kRuns = 2000;
  constexpr double kNoise = 0.01;
  for (int run = 0; run < kRuns; ++run) {
    const Eigen::VectorXd y = clean.unaryExpr([&](double v) { return v + kNoise * random.normal(); });
    const auto fit = levenberg_marquardt(decay(times, y), Eigen::Vector2d(1.0, 1.0));
    REQUIRE(fit);
    REQUIRE(fit->converged);
    const Eigen::Vector2d error = fit->parameters - truth;
    squares += error * error.transpose() / kRuns;
    if (run == 0) predicted = kNoise * kNoise * *inverse_normal_matrix(fit->jacobian);
  }
  // 2000 runs give a variance to 3.2 %.
  CHECK(squares(0, 0) == Approx(predicted(0, 0)).epsilon(0.13));
  CHECK(squares(1, 1) == Approx(predicted(1, 1)).epsilon(0.13));
  CHECK(squares(0, 1) == Approx(predicted(0, 1)).epsilon(0.2));
}

TEST_CASE("levenberg_marquardt steps back from parameters outside the domain") {
  LeastSquaresProblem problem;  // log(p) = 1 from a start whose full step is negative
  problem.residuals = 1;
  problem.residual = [](const Eigen::VectorXd& p, Eigen::VectorXd& r) { r[0] = std::log(p[0]) + 1.0; };
  problem.jacobian = [](const Eigen::VectorXd& p, Eigen::MatrixXd& j) { j(0, 0) = 1.0 / p[0]; };
  const auto fit = levenberg_marquardt(problem, Eigen::VectorXd::Constant(1, 20.0));
  REQUIRE(fit);
  CHECK(fit->parameters[0] == Approx(std::exp(-1.0)).epsilon(1e-10));
}

TEST_CASE("levenberg_marquardt says that its evaluations were used up") {
  const Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(9, 0.0, 1.0);
  const auto fit = levenberg_marquardt(decay(times, times), Eigen::Vector2d(9.0, -9.0), {2, 1e-13});
  REQUIRE(fit);
  CHECK_FALSE(fit->converged);
  CHECK(fit->reason == "the evaluations allowed are used up");
}

TEST_CASE("least squares without an answer are refused") {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(1), two = Eigen::VectorXd::Ones(2);
  CHECK(levenberg_marquardt(decay(one, one), Eigen::Vector2d(1, 1)).error().text == "1 residuals do not determine 2 parameters");
  const Eigen::Vector2d nan(std::numeric_limits<double>::quiet_NaN(), 1.0);
  CHECK(levenberg_marquardt(decay(two, two), nan).error().text == "the residuals are not finite at the starting values");
  Eigen::MatrixXd j(3, 2);
  j << 1, 2, 1, 2, 1, 2;
  CHECK(inverse_normal_matrix(j, {"gain", "pole"}).error().text ==
        "the data leave a combination of the parameters free, gain above all");
  j.col(1).setZero();
  CHECK(inverse_normal_matrix(j).error().text == "the data say nothing about parameter 2");
}
