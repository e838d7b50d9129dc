// The motor behind a staircase and a delay.

#include "frisch/hold.hpp"

#include <Eigen/LU>
#include <bodeflow/numerics/discretise.hpp>

#include "catch.hpp"
#include "motor.hpp"

using namespace bodeflow::frisch;
using bodeflow::test::paper_motor;

namespace {

/// Currents of the two states i and psi' = alpha Lm i - alpha psi, from the state equations (16).
bodeflow::numerics::StateSpace state_equations(const MotorModel& m) {
  bodeflow::numerics::StateSpace s;
  // Flux in the unit that makes beta 1: d psi = alpha Lm_beta i - alpha psi, d i = -gamma i + alpha psi + v/sigma.
  s.A = (Eigen::MatrixXd(2, 2) << -m.gamma, m.alpha, m.alpha * m.lm_beta, -m.alpha).finished();
  s.B = (Eigen::MatrixXd(2, 1) << 1.0 / m.sigma, 0.0).finished();
  s.C = (Eigen::MatrixXd(1, 2) << 1.0, 0.0).finished();
  s.D = Eigen::MatrixXd::Zero(1, 1);
  return s;
}

Eigen::VectorXd both_bands() {
  return bodeflow::test::stacked(bodeflow::test::low_band(1.0).omega(), bodeflow::test::high_band(1.0).omega());
}

}  // namespace

TEST_CASE("frisch: the response behind a hold is that of the state equations, discretised by the matrix exponential") {
  const MotorModel m = paper_motor();
  for (const double step : {1e-6, 200e-6, 4e-3}) {
    const auto discrete = bodeflow::numerics::zero_order_hold(state_equations(m), step);
    REQUIRE(discrete);
    const auto& d = discrete->model;
    for (const double w : {0.7669904, 30.0, 600.0}) {
      const std::complex<double> z = std::polar(1.0, w * step);
      const Eigen::MatrixXcd resolvent = z * Eigen::MatrixXcd::Identity(2, 2) - d.A;
      const std::complex<double> expected = (d.C * resolvent.lu().solve(d.B.cast<std::complex<double>>()))(0, 0);
      CAPTURE(step, w);
      CHECK(std::abs(held_response(m, w, step) / expected - 1.0) < 1e-9);
    }
  }
}

TEST_CASE("frisch: a fit behind hold and delay finds the motor exactly, and a wrong one without them") {
  const MotorModel truth = paper_motor();
  const Eigen::VectorXd omega = both_bands(), ones = Eigen::VectorXd::Ones(omega.size());
  for (const auto& [hold, delay] :
       {std::pair{200e-6, 0.0}, std::pair{4e-3, 0.0}, std::pair{0.0, 150e-6}, std::pair{1e-4, 50e-6}}) {
    CAPTURE(hold, delay);
    const Sampling sampling{hold, delay};
    const Eigen::VectorXcd measured =
        bodeflow::frisch::response(truth, omega).cwiseQuotient(continuous_factor(truth, omega, sampling));
    const auto fit = fit_behind_hold(
        [&](const Eigen::VectorXcd& factor) { return fit_motor(omega, measured.cwiseProduct(factor), ones); }, omega, sampling);
    REQUIRE(fit);
    CHECK(fit->model.vector().cwiseQuotient(truth.vector()).isApproxToConstant(1.0, 1e-9));
    const auto without = fit_motor(omega, measured, ones);
    REQUIRE(without);
    CHECK(std::abs(without->model.sigma / truth.sigma - 1.0) > 0.02);
  }
}

TEST_CASE("frisch: lines beyond half the rate of the hold are refused") {
  const Eigen::VectorXd omega = both_bands();
  const auto fit = fit_behind_hold([&](const Eigen::VectorXcd&) -> Expected<MotorFit> { return MotorFit{}; }, omega, {0.01, 0.0});
  REQUIRE_FALSE(fit);
  CHECK(fit.error().text == "a line at 95.703125 Hz is not below half the rate of the hold, 50.000000 Hz; is hold right?");
}
