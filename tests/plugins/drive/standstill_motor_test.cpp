#include "drive/standstill_motor.hpp"

#include <Eigen/LU>
#include <bodeflow/numerics/discretise.hpp>
#include <bodeflow/numerics/random.hpp>

#include "catch.hpp"
#include "drive/voltage_steps.hpp"

using namespace bodeflow;
using namespace bodeflow::drive;

namespace {

constexpr double kPeriod = 1e-4;
constexpr MotorParameters kPaper{6.6, 5.5, 0.475, 0.475, 0.454};

HiddenPhysics bars_and_iron() {
  HiddenPhysics hidden;
  hidden.bar_height = 0.012;
  hidden.iron_loss_resistance = 800.0;
  return hidden;
}

/// One axis of a network as a state-space model from voltage to current; states are the loop currents.
numerics::StateSpace model_of(const MotorNetwork& network) {
  const Eigen::MatrixXd inverse = network.inductance.inverse();
  numerics::StateSpace model;
  model.A = -inverse * Eigen::MatrixXd(network.resistance.asDiagonal());
  model.B = inverse.col(0);
  model.C = Eigen::MatrixXd::Identity(1, network.loops());
  model.D = Eigen::MatrixXd::Zero(1, 1);
  return model;
}

/// Both axes, each an exact zero-order hold of any length.
struct Reference {
  explicit Reference(const MotorNetwork& network)
      : model(model_of(network)), alpha(Eigen::VectorXd::Zero(network.loops())), beta(alpha) {}
  void hold(double length, AlphaBeta v) {
    const numerics::StateSpace step = numerics::zero_order_hold(model, length)->model;
    alpha = (step.A * alpha + step.B * v.alpha).eval();
    beta = (step.A * beta + step.B * v.beta).eval();
  }
  numerics::StateSpace model;
  Eigen::VectorXd alpha, beta;
};

}  // namespace

TEST_CASE("standstill motor: constant voltage gives the zero-order hold of equation (17) to 1e-12") {
  const MotorNetwork network = *motor_network(kPaper, {});
  StandstillMotor motor(network, 1.0, kPeriod);
  const ModelConstants c = constants_of(kPaper);
  const numerics::TransferFunction g{Eigen::Vector2d(1.0, c.alpha) / c.sigma,
                                     Eigen::Vector3d(1.0, c.gamma + c.alpha, c.alpha * (c.gamma - c.alpha * c.lm_beta))};
  const numerics::StateSpace step = numerics::zero_order_hold(*numerics::to_state_space(g), kPeriod)->model;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2);
  double worst = 0.0, largest = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const double v = 5.0 * std::sin(1e-6 * n * n);
    x = (step.A * x + step.B * v).eval();
    motor.advance({v, 0.0}, 0.0);
    const double expected = (step.C * x)[0];
    largest = std::max(largest, std::abs(expected));
    worst = std::max(worst, std::abs(motor.outputs().current.alpha - expected));
  }
  CHECK(worst < 1e-12 * largest);
}

TEST_CASE("standstill motor: any switching gives the chain of zero-order holds to 1e-12, with and without hidden loops") {
  for (const HiddenPhysics& hidden : {HiddenPhysics{}, bars_and_iron()}) {
    const MotorNetwork network = *motor_network(kPaper, hidden);
    StandstillMotor motor(network, 1.0, kPeriod);
    Reference reference(network);
    auto random = numerics::Random::stream(7, 0);
    double worst = 0.0, largest = 0.0;
    for (int n = 0; n < 100; ++n) {
      std::array<Pulse, 3> legs;
      for (Pulse& p : legs) {
        p.on = kPeriod * random.uniform();
        p.off = p.on + (kPeriod - p.on) * random.uniform();
      }
      motor.advance(legs, 540.0, 0.0);
      const VoltageSteps steps = voltage_steps(legs, 540.0, kPeriod);
      for (std::size_t k = 0; k < steps.count; ++k) reference.hold(steps.length[k], steps.voltage[k]);
      const AlphaBeta i = motor.outputs().current;
      largest = std::max(largest, std::abs(reference.alpha[0]));
      worst = std::max({worst, std::abs(i.alpha - reference.alpha[0]), std::abs(i.beta - reference.beta[0])});
    }
    INFO(network.loops() << " loops");
    CHECK(worst < 1e-12 * largest);
  }
}

TEST_CASE("standstill motor: a new stator resistance leaves the currents as they are") {
  StandstillMotor motor(*motor_network(kPaper, bars_and_iron()), 1.0, kPeriod);
  for (int n = 0; n < 50; ++n) motor.advance({20.0, -7.0}, 0.0);
  const LoopCurrents before = motor.state().currents;
  motor.set_stator_resistance(8.0);
  CHECK((motor.state().currents - before).norm() < 1e-13 * before.norm());
  for (int n = 0; n < 100000; ++n) motor.advance({20.0, -7.0}, 0.0);
  CHECK(motor.outputs().current.alpha == Approx(20.0 / 8.0).epsilon(1e-10));
}
