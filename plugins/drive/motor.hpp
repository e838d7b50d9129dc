#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

#include "clarke.hpp"
#include "motor_network.hpp"
#include "pwm.hpp"

namespace bodeflow::drive {

/// The shaft: inertia d omega/dt = torque - load - friction omega, omega in mechanical rad/s.
struct Mechanics {
  double pole_pairs = 1.0;
  double inertia = 0.0;   ///< [kg m^2]
  double friction = 0.0;  ///< [Nm s/rad]
  double initial_speed = 0.0;
  bool locked = true;  ///< the rotor stands still
};

struct MotorSetup {
  MotorParameters electrical;
  HiddenPhysics hidden;
  Mechanics mechanics;
  double period_s = 1e-4;
};

/// Loop currents of both axes (row 0 alpha, row 1 beta), in the stator frame.
using LoopCurrents = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMostLoops>;

struct MotorState {
  LoopCurrents currents;
  double speed = 0.0;     ///< mechanical [rad/s]
  double position = 0.0;  ///< mechanical [rad], not wrapped
};

/// What the terminals, the shaft and an observer see at the start of a period.
struct MotorOutputs {
  AlphaBeta current;  ///< of the stator [A, peak]
  AlphaBeta flux;     ///< linked with the rotor [Vs, peak]
  double torque = 0.0;
  double speed = 0.0;
  double position = 0.0;
};

/// An induction motor, stepped from one PWM period to the next.
///
/// Model (16) of Castaldi, Montanari, Tilli 2002 with the torque pole_pairs mu (psi_a i_b - psi_b i_a) and omega in electrical
/// rad/s in the flux equations, in the coordinates (stator flux, rotor flux, omega), plus the loops and the saturation of
/// HiddenPhysics. Torque in general: 3/2 pole_pairs times the sum of flux cross current over the loops that turn.
class Motor {
 public:
  virtual ~Motor() = default;

  /// One period with constant voltage.
  virtual void advance(AlphaBeta voltage, double load_torque) = 0;
  /// One period with the legs of an inverter: each leg is at `link` volts between its instants, else at 0.
  virtual void advance(const std::array<Pulse, 3>& legs, double link, double load_torque) = 0;

  virtual MotorOutputs outputs() const = 0;
  virtual MotorState state() const = 0;
  /// Loops that `state` does not have begin without current.
  virtual void set_state(const MotorState& state) = 0;
  virtual void set_stator_resistance(double ohm) = 0;

  /// A voltage that something in series takes from the terminals, held until another is set.
  void set_drop(AlphaBeta volts) { drop_ = volts; }

 protected:
  AlphaBeta drop_;
};

/// The motor without current. A linear motor at standstill is solved exactly (standstill_motor.hpp), any other by Runge-Kutta
/// steps: model (16) by five_state_motor.hpp, hidden loops and saturation by turning_motor.hpp. Errors: those of `motor_network`;
/// saturation without leakage on both sides; a shaft that may turn without inertia.
numerics::Expected<std::unique_ptr<Motor>> make_motor(const MotorSetup& setup);

}  // namespace bodeflow::drive
