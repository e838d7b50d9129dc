#include "bodeflow/numerics/discretise.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>

#include "bodeflow/numerics/balance.hpp"

namespace bodeflow::numerics {
namespace {

constexpr double kWhole = 1e-9;
constexpr double kOnRealAxis = 1e-14;  // relative imaginary part that is rounding

struct Transition {
  Eigen::MatrixXd phi;
  Eigen::MatrixXd gamma;
};

Transition transition(const StateSpace& system, double time) {
  const Eigen::Index n = system.states();
  const Eigen::Index inputs = system.inputs();
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(n + inputs, n + inputs);
  block.topLeftCorner(n, n) = system.A * time;
  block.topRightCorner(n, inputs) = system.B * time;
  Eigen::VectorXd scales = Eigen::VectorXd::Ones(n + inputs);
  scales.head(n) = balancing_scales(block.topLeftCorner(n, n));
  // The inputs' scale is free: equal to the largest state's share, B does not add to the norm that sets the squarings.
  const Eigen::MatrixXd scaled = scaled_by(block, scales);
  const double b = scaled.rightCols(inputs).cwiseAbs().maxCoeff();
  const double a = scaled.leftCols(n).cwiseAbs().maxCoeff();
  if (b > 0) scales.tail(inputs).setConstant(std::exp2(std::floor(std::log2((a > 0 ? a : 1.0) / b))));
  const Eigen::MatrixXd balanced = scaled_by(block, scales);
  const Eigen::MatrixXd result = scaled_by(balanced.exp(), scales.cwiseInverse());
  return {result.topLeftCorner(n, n), result.topRightCorner(n, inputs)};
}

StateSpace with_late_input(const StateSpace& system, const Transition& whole, const Transition& before, const Transition& after) {
  const Eigen::Index n = system.states();
  const Eigen::Index inputs = system.inputs();
  StateSpace late;
  late.A = Eigen::MatrixXd::Zero(n + inputs, n + inputs);
  late.A.topLeftCorner(n, n) = whole.phi;
  late.A.topRightCorner(n, inputs) = after.phi * before.gamma;
  late.B.resize(n + inputs, inputs);
  late.B << after.gamma, Eigen::MatrixXd::Identity(inputs, inputs);
  late.C.resize(system.outputs(), n + inputs);
  late.C << system.C, system.D;
  late.D = Eigen::MatrixXd::Zero(system.outputs(), inputs);
  return late;
}

}  // namespace

SplitDelay split_delay(double delay_s, double sample_time) {
  const double quotient = delay_s / sample_time;
  const double nearest = std::round(quotient);
  if (std::abs(quotient - nearest) <= kWhole * std::max(1.0, nearest)) return {static_cast<Eigen::Index>(nearest), 0.0};
  const double samples = std::floor(quotient);
  return {static_cast<Eigen::Index>(samples), delay_s - samples * sample_time};
}

Expected<DelayedModel> zero_order_hold(const StateSpace& system, double sample_time, double delay_s) {
  if (system.sample_time != 0) return refused("the system is already a discrete-time one");
  if (!(sample_time > 0) || !std::isfinite(sample_time)) return refused("the sample time must be above 0");
  if (!(delay_s >= 0) || !std::isfinite(delay_s)) return refused("the delay must not be negative");
  const SplitDelay delay = split_delay(delay_s, sample_time);
  DelayedModel result{system, delay.samples};
  if (system.states() > 0 || delay.rest_s > 0) {
    const Transition whole = transition(system, sample_time);
    if (delay.rest_s > 0) {
      result.model =
          with_late_input(system, whole, transition(system, delay.rest_s), transition(system, sample_time - delay.rest_s));
    } else {
      result.model.A = whole.phi;
      result.model.B = whole.gamma;
    }
  }
  result.model.sample_time = sample_time;
  if (!result.model.A.allFinite() || !result.model.B.allFinite()) {
    return refused("the system grows beyond the range of a double within one sample");
  }
  return result;
}

Expected<StateSpace> undo_zero_order_hold(const StateSpace& system) {
  if (system.sample_time == 0.0) return refused("the system is already a continuous-time one");
  StateSpace result = system;
  result.sample_time = 0.0;
  const Eigen::Index n = system.states(), inputs = system.inputs();
  if (n == 0) return result;
  for (const std::complex<double>& z : system.A.eigenvalues()) {
    if (std::abs(z.imag()) <= kOnRealAxis * std::abs(z) && z.real() <= 0.0)
      return refused("a pole at z = " + std::to_string(z.real()) + ": no continuous-time system of as many states has it");
  }
  Eigen::MatrixXd block = Eigen::MatrixXd::Identity(n + inputs, n + inputs);
  block.topLeftCorner(n, n) = system.A;
  block.topRightCorner(n, inputs) = system.B;
  const Eigen::MatrixXd logarithm = block.log();
  result.A = logarithm.topLeftCorner(n, n) / system.sample_time;
  result.B = logarithm.topRightCorner(n, inputs) / system.sample_time;
  if (!result.A.allFinite() || !result.B.allFinite())
    return refused("the logarithm of the system is beyond the range of a double");
  return result;
}

}  // namespace bodeflow::numerics
