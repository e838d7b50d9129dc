#include "motor_standstill.hpp"

#include <Eigen/Dense>
#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/fft.hpp>
#include <bodeflow/numerics/frequency_response.hpp>
#include <cmath>
#include <numbers>

#include "catalogue.hpp"
#include "catch.hpp"
#include "simple_bench.hpp"

using namespace bodeflow;
using namespace bodeflow::residual;

namespace {

// Table 1 of Castaldi, Montanari, Tilli 2002.
const Eigen::Vector4d kTable1(283.0287, 11.57895, 10.56518, 0.04107158);

numerics::StateSpace table_1() {
  const auto& p = kTable1;
  numerics::TransferFunction g;
  g.numerator = Eigen::Vector2d(1, p[1]) / p[3];
  g.denominator = Eigen::Vector3d(1, p[0] + p[1], p[1] * (p[0] - p[1] * p[2]));
  return numerics::to_state_space(g).value();
}

/// What the model predicts at the excited lines, relative to what the other simulation of the bench gives.
double disagreement(const bench::SimpleBench& b, const Extension& extension) {
  bench::SimpleBench quiet = b;
  quiet.noise_std = 1e-6;
  const Experiment e = experiment_of(bench::record(quiet, 4.0, 3, 2), "x").value();
  const MotorStandstill model(MotorInput::command, b.computation_delay_s);
  const Eigen::VectorXcd predicted = model.steady_state(e, kTable1, extension);
  double error = 0, size = 0;
  for (Eigen::Index k = 1; k < e.lines(); ++k) {
    error += std::norm(e.output[k] - predicted[k]);
    size += std::norm(e.output[k]);
  }
  return std::sqrt(error / size);
}

}  // namespace

TEST_CASE("motor at standstill: circuit and transfer function are the same motor") {
  const TCircuit c = t_circuit(kTable1);
  CHECK(c.rs == Approx(6.6).epsilon(1e-5));
  CHECK(c.rr == Approx(5.5).epsilon(1e-5));
  CHECK(c.lm == Approx(0.454).epsilon(1e-5));
  CHECK(c.leakage == Approx(0.021).epsilon(1e-4));
  const MotorModes m = motor_modes(kTable1);
  CHECK(m.pole[0] == Approx(-288.1503).epsilon(1e-6));
  CHECK(m.pole[1] == Approx(-6.45732).epsilon(1e-5));
}

TEST_CASE("motor at standstill: the response behind a hold and any delay is that of the exact discretisation") {
  const double sample_time = 1e-3;
  for (const double delay : {0.0, 100e-6, 1e-3, 1.35e-3, 4e-3}) {
    const MotorStandstill model(MotorInput::command, delay);
    const auto exact = numerics::zero_order_hold(table_1(), sample_time, delay).value();
    for (const double f : {0.25, 7.0, 60.0, 211.0}) {
      const std::complex<double> z = std::polar(1.0, 2 * std::numbers::pi * f * sample_time);
      const Eigen::MatrixXcd a = exact.model.A.cast<std::complex<double>>();
      const Eigen::MatrixXcd core = z * Eigen::MatrixXcd::Identity(a.rows(), a.cols()) - a;
      const std::complex<double> wanted =
          (exact.model.C.cast<std::complex<double>>() * core.partialPivLu().solve(exact.model.B.cast<std::complex<double>>()) +
           exact.model.D.cast<std::complex<double>>())(0, 0) *
          std::pow(z, -static_cast<int>(exact.delay));
      const std::complex<double> found = model.response(kTable1, f, sample_time, 0.0);
      INFO("delay " << delay << " s, " << f << " Hz");
      CHECK(std::abs(found - wanted) < 1e-11 * std::abs(wanted));
    }
  }
}

TEST_CASE("motor at standstill: the simulation without an effect is the closed form, with a hold and with a sampled voltage") {
  const auto effects = catalogue({"dead_time", "saturation"}).value();
  const Experiment e = experiment_of(bench::record({}, 4.0, 1, 2), "x").value();
  // Effects of no size, so that the model is simulated.
  const Extension none_lost{{effects[0].get(), Eigen::Vector2d(1e-9, 1.0)}};
  const Extension none_stored{{effects[1].get(), Eigen::Vector3d(1e-12, 1e-12, 1e-12)}};
  for (const MotorInput input : {MotorInput::command, MotorInput::period_mean, MotorInput::terminal}) {
    const MotorStandstill model(input, input == MotorInput::command ? 137e-6 : 0.0);
    const Eigen::VectorXcd closed = model.steady_state(e, kTable1, {});
    // A sampled voltage is held over tenths of a sample, whose images fold back.
    const double images = input == MotorInput::terminal ? 2e-4 : 0.0;
    CHECK((model.steady_state(e, kTable1, none_lost) - closed).norm() < (2e-6 + images) * closed.norm());
    CHECK((model.steady_state(e, kTable1, none_stored) - closed).norm() < (4e-5 + images) * closed.norm());
  }
}

TEST_CASE("motor at standstill: agrees with another simulation, alone, late, with dead time, and with mild saturation") {
  const auto effects = catalogue().value();
  bench::SimpleBench b;
  CHECK(disagreement(b, {}) < 2e-4);
  b.delay_s = 200e-6;
  CHECK(disagreement(b, {{effects[0].get(), Eigen::VectorXd::Constant(1, 200e-6)}}) < 2e-4);
  b.delay_s = 0;
  b.dead_time_voltage = 5;
  CHECK(disagreement(b, {}) > 0.1);
  CHECK(disagreement(b, {{effects[1].get(), Eigen::Vector2d(5.0, 5e-3)}}) < 6e-3);
  b.dead_time_voltage = 0;
  b.saturation_current = 6;
  // tanh(x) = x - x^3/3 ...: the share 0.75 of it bends the current by 0.25 (psi / (Lm isat))^2.
  const double square = std::pow(0.454 * 6, 2);
  CHECK(disagreement(b, {}) > 2e-3);
  CHECK(disagreement(b, {{effects[2].get(), Eigen::Vector3d(0.25 / square, 0.1 / (square * square), 1e-9)}}) < 3e-4);
}

TEST_CASE("motor at standstill: resistances that are not positive are outside of the domain") {
  const Experiment e = experiment_of(bench::record({}, 4.0, 1, 2), "x").value();
  const MotorStandstill model(MotorInput::command, 0.0);
  CHECK_FALSE(model.steady_state(e, Eigen::Vector4d(100, 11, 10, 0.04), {}).allFinite());
}
