#include "frisch/motor_model.hpp"

#include <Eigen/LU>
#include <complex>

#include "../reference_file.hpp"
#include "catch.hpp"
#include "motor.hpp"

using namespace bodeflow::frisch;
using bodeflow::test::paper_motor;
using Complex = std::complex<double>;

namespace {
Eigen::VectorXd all_omega() {
  return bodeflow::test::stacked(bodeflow::test::low_band(1).omega(), bodeflow::test::high_band(1).omega());
}
}  // namespace

TEST_CASE("frisch: the paper's resistances and inductances give its poles, zero and static gain") {
  const MotorModel m = paper_motor();
  CHECK(m.gamma == Approx(283.0287).epsilon(1e-6));
  CHECK(m.alpha == Approx(11.57895).epsilon(1e-6));
  CHECK(m.lm_beta == Approx(10.56518).epsilon(1e-6));
  CHECK(m.sigma == Approx(0.04107158).epsilon(1e-6));
  CHECK(response(m, 0.0).real() == Approx(1.0 / 6.6).epsilon(1e-12));
  const Complex s(0.0, 7.0), g = (s + 11.578947368) / (m.sigma * (s + 288.1503) * (s + 6.45732));
  CHECK(std::abs(response(m, 7.0) - g) < 1e-6 * std::abs(g));
  CHECK(std::abs(1.0 / response(m, 7.0) - (6.6 + s * m.sigma + m.sigma * m.lm_beta * m.alpha * s / (s + m.alpha))) < 1e-12);
}

TEST_CASE("frisch: the motor's response is that of its state equations with the rotor flux as a state") {
  const MotorModel m = paper_motor();
  const double Lm = 0.454, beta = m.lm_beta / Lm;
  Eigen::Matrix2cd dynamics;  // i' = -gamma i + alpha beta psi + V/sigma, psi' = -alpha psi + alpha Lm i
  dynamics << -m.gamma, m.alpha * beta, m.alpha * Lm, -m.alpha;
  for (const double omega : {0.7, 30.0, 600.0}) {
    const Eigen::Matrix2cd resolvent = (Complex(0.0, omega) * Eigen::Matrix2cd::Identity() - dynamics).inverse();
    CHECK(std::abs(resolvent(0, 0) / m.sigma - response(m, omega)) < 1e-12);
  }
}

TEST_CASE("frisch: slopes of the response are those of central differences") {
  const MotorModel m = paper_motor();
  for (const double omega : {0.7, 30.0, 600.0}) {
    const ResponseSlope g = response_slope(m, omega);
    CHECK(g.value == response(m, omega));
    for (Eigen::Index i = 0; i < 4; ++i) {
      Eigen::Vector4d up = m.vector(), down = up;
      up[i] *= std::exp(1e-6);
      down[i] *= std::exp(-1e-6);
      const Complex difference = (response(MotorModel::of(up), omega) - response(MotorModel::of(down), omega)) / 2e-6;
      CHECK(std::abs(difference - g.slope[i]) < 1e-8 * std::abs(g.value));
    }
  }
}

TEST_CASE("frisch: a clean response gives the motor exactly, from the start on") {
  const MotorModel m = paper_motor();
  const Eigen::VectorXd omega = all_omega();
  const Eigen::VectorXcd g = response(m, omega);
  const auto start = motor_start(omega, g);
  REQUIRE(start);
  CHECK(start->vector().cwiseQuotient(m.vector()).isApproxToConstant(1.0, 1e-9));
  const auto fit = fit_motor(omega, g, Eigen::VectorXd::Ones(48));
  REQUIRE(fit);
  CHECK(fit->model.vector().cwiseQuotient(m.vector()).isApproxToConstant(1.0, 1e-9));
}

TEST_CASE("frisch: resistances and inductances come back under equal inductances, and what is identifiable without that") {
  MotorFit fit;
  fit.model = paper_motor();
  fit.covariance.setIdentity();
  const auto p = identifiable_parameters(fit);
  CHECK(p.stator_resistance_ohm == Approx(6.6).epsilon(1e-10));
  CHECK(p.stator_inductance_h == Approx(0.475).epsilon(1e-10));
  CHECK(p.rotor_time_constant_s == Approx(0.475 / 5.5).epsilon(1e-10));
  CHECK(p.leakage_inductance_h == Approx(0.04107158).epsilon(1e-6));
  const auto e = equal_inductance_parameters(fit);
  CHECK(e.stator_resistance_ohm == Approx(6.6).epsilon(1e-10));
  CHECK(e.rotor_resistance_ohm == Approx(5.5).epsilon(1e-10));
  CHECK(e.rotor_inductance_h == Approx(0.475).epsilon(1e-10));
  CHECK(e.mutual_inductance_h == Approx(0.454).epsilon(1e-10));
  // Another rotor with the same response: only the identifiable ones stay.
  fit.model = *motor_model(6.6, 5.5 * 1.44, 0.475, 0.475 * 1.44, 0.454 * 1.2);
  CHECK(fit.model.vector().isApprox(paper_motor().vector(), 1e-12));
}

TEST_CASE("frisch: covariances of physical parameters are those of finite differences") {
  MotorFit fit;
  fit.model = paper_motor();
  Eigen::Matrix4d root = Eigen::Matrix4d::Identity();
  root(1, 0) = 0.4;
  root(3, 2) = -0.3;
  const Eigen::Matrix4d scale = (0.01 * fit.model.vector()).asDiagonal();
  fit.covariance = scale * root * root.transpose() * scale;
  Eigen::Matrix<double, 4, 4> slope;
  Eigen::Matrix<double, 5, 4> equal_slope;
  for (Eigen::Index i = 0; i < 4; ++i) {
    const auto moved = [&](double by) {
      MotorFit other = fit;
      Eigen::Vector4d p = fit.model.vector();
      p[i] *= 1.0 + by;
      other.model = MotorModel::of(p);
      const auto a = identifiable_parameters(other);
      const auto b = equal_inductance_parameters(other);
      Eigen::VectorXd v(9);
      v << a.stator_resistance_ohm, a.stator_inductance_h, a.rotor_time_constant_s, a.leakage_inductance_h,
          b.stator_resistance_ohm, b.rotor_resistance_ohm, b.stator_inductance_h, b.rotor_inductance_h, b.mutual_inductance_h;
      return v;
    };
    const Eigen::VectorXd d = (moved(1e-6) - moved(-1e-6)) / (2e-6 * fit.model.vector()[i]);
    slope.col(i) = d.head(4);
    equal_slope.col(i) = d.tail(5);
  }
  CHECK(identifiable_parameters(fit).covariance.isApprox(slope * fit.covariance * slope.transpose(), 1e-7));
  CHECK(equal_inductance_parameters(fit).covariance.isApprox(equal_slope * fit.covariance * equal_slope.transpose(), 1e-7));
}
