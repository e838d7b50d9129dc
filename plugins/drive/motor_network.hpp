#pragma once

#include <Eigen/Core>

#include "motor_parameters.hpp"

namespace bodeflow::drive {

/// What a real motor does beside model (16). 0 switches an effect off.
struct HiddenPhysics {
  double saturation_current = 0.0;    ///< isat [A, peak of the magnetising current]
  double saturation_share = 0.75;     ///< of the magnetising inductance, at small currents
  double bar_height = 0.0;            ///< of a rotor bar in its slot [m]
  double bar_share = 0.6;             ///< of the rotor's resistance that lies in the slots
  double bar_conductivity = 2.7e7;    ///< [S/m], warm aluminium
  double iron_loss_resistance = 0.0;  ///< parallel to the magnetising inductance [ohm]
  double resistance_drift = 0.0;      ///< final relative rise of Rs
  double thermal_time = 300.0;        ///< of that rise [s]
};

inline constexpr int kMostLoops = 8;
using LoopVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostLoops, 1>;
using LoopMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostLoops, kMostLoops>;

/// The loops of one axis of the motor: loop 0 is the stator, loop 1 the rotor, then the eddy currents of the bars, last the iron
/// loss. With the loop currents x, the loops have the flux linkages y = inductance x, and at standstill
///   dy/dt = -resistance x + (v, 0, ..., 0).
/// Both matrices are symmetric and positive definite: the network is passive, so its modes are real and stable.
struct MotorNetwork {
  LoopMatrix inductance;  ///< unsaturated
  LoopVector resistance;  ///< a diagonal
  LoopVector magnetises;  ///< +-1 where the loop's current flows through the magnetising branch: i_m = magnetises . x
  double lm = 0.0;
  int rotor_loops = 1;  ///< loops 1 .. rotor_loops turn with the rotor
  bool iron = false;    ///< the last loop is the iron loss

  Eigen::Index loops() const { return resistance.size(); }
};

/// The network of a motor. Bars: the field diffuses into a slot of height h, so a bar's impedance is R z coth z with z^2 = s tau,
/// tau = mu0 conductivity h^2. Its continued fraction R (1 + z^2/(3 + z^2/(5 + ...))) is a ladder of resistors R, 5R, 9R, ... in
/// series and inductors R tau/3, R tau/7, ... across: loops of eddy currents. At 0 Hz rotor resistance and inductance are the
/// parameters themselves; with frequency the resistance rises and the leakage falls.
/// Errors: bars whose slots hold more leakage than the motor has; values out of range.
/// Reference: J. Pyrhonen, T. Jokinen, V. Hrabovcova, Design of Rotating Electrical Machines, 2nd ed., 2014, section 5.2.
numerics::Expected<MotorNetwork> motor_network(const MotorParameters& p, const HiddenPhysics& hidden);

/// What is left of the inductance when the magnetising branch is saturated down to `share` of lm.
LoopMatrix saturated_inductance(const MotorNetwork& network, double share);

/// Modes of the network: x = vectors z, dz/dt = -rates z + row 0 of `vectors` times v. The vectors are orthonormal in the
/// inductance, so z = vectors^T inductance x.
struct Modes {
  LoopVector rates;  ///< rising [1/s]
  LoopMatrix vectors;
};
Modes modes_of(const LoopMatrix& inductance, const LoopVector& resistance);

}  // namespace bodeflow::drive
