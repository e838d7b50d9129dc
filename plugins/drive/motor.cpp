#include "motor.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>

#include "five_state_motor.hpp"
#include "records/signals.hpp"
#include "standstill_motor.hpp"
#include "turning_motor.hpp"

namespace bodeflow::drive {
namespace {

using numerics::Expected;
using numerics::refused;
using records::short_number;

double fastest(const LoopMatrix& inductance, const LoopVector& resistance) {
  return modes_of(inductance, resistance).rates.maxCoeff();
}

/// The curve as the network of `TurningMotor` sees it.
MagnetisingCurve curve_of(const MotorNetwork& network, const HiddenPhysics& hidden) {
  if (network.iron) return {network.lm, hidden.saturation_current, hidden.saturation_share, 0.0, 1.0};
  const LoopMatrix leakage = saturated_inductance(network, 0.0);
  const double stiffness = network.magnetises.dot(leakage.llt().solve(network.magnetises));
  return {network.lm, hidden.saturation_current, hidden.saturation_share, 1.0, stiffness};
}

template <int kLoops>
std::unique_ptr<Motor> turning(const MotorNetwork& network, const MotorSetup& setup) {
  std::optional<MagnetisingCurve> curve;
  double rate = fastest(network.inductance, network.resistance);
  if (setup.hidden.saturation_current > 0.0) {
    curve = curve_of(network, setup.hidden);
    rate = std::max(rate, fastest(saturated_inductance(network, 1.0 - setup.hidden.saturation_share), network.resistance));
  }
  return std::make_unique<TurningMotor<kLoops>>(network, std::move(curve), rate, setup.mechanics, setup.period_s);
}

}  // namespace

Expected<std::unique_ptr<Motor>> make_motor(const MotorSetup& setup) {
  const auto parameters = checked(setup.electrical);
  if (!parameters) return refused(parameters.error().text);
  const auto network = motor_network(setup.electrical, setup.hidden);
  if (!network) return refused(network.error().text);
  const bool saturates = setup.hidden.saturation_current > 0.0;
  const Eigen::Index windings = network->loops() - (network->iron ? 1 : 0);
  if (saturates && saturated_inductance(*network, 0.0).topLeftCorner(windings, windings).llt().info() != Eigen::Success) {
    const TForm t = t_form(setup.electrical);
    return refused("saturation of the magnetising branch needs leakage on both sides; found " + short_number(t.stator_leakage) +
                   " H on the stator's and " + short_number(t.rotor_leakage) + " H on the rotor's, slots of the bars included");
  }
  if (!setup.mechanics.locked && !(setup.mechanics.inertia > 0.0)) {
    return refused("the motor may turn and has inertia = " + short_number(setup.mechanics.inertia) +
                   " kg m^2, allowed: positive, or standstill");
  }
  if (setup.mechanics.locked && !saturates) {
    return std::make_unique<StandstillMotor>(*network, setup.mechanics.pole_pairs, setup.period_s);
  }
  if (!setup.mechanics.locked && !saturates && network->loops() == 2) {
    const double rate = fastest(network->inductance, network->resistance);
    return std::make_unique<FiveStateMotor>(setup.electrical, rate, setup.mechanics, setup.period_s);
  }
  switch (network->loops()) {
    case 2:
      return turning<2>(*network, setup);
    case 3:
      return turning<3>(*network, setup);
    case 6:
      return turning<6>(*network, setup);
    default:
      return turning<7>(*network, setup);
  }
}

}  // namespace bodeflow::drive
