#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "parameter.hpp"

namespace bodeflow::residual {

/// What a base model knows of the experiments before an effect is fitted, for starts and steps.
struct Scales {
  double sample_time_s = 0.0;
  double effort = 0.0;  ///< root mean square of the input (voltage, force)
  double flow = 0.0;    ///< greatest magnitude of the through quantity (current, velocity)
  double stored = 0.0;  ///< greatest magnitude of the stored quantity (flux, displacement)
};

/// A value and its slope.
struct Law {
  double value = 0.0;
  double slope = 0.0;
};

/// Something physical that a base model lacks and that can be added to it. An effect acts through hooks that any base model
/// offers; hooks of several effects add up, so pairs of effects need no code of their own. Effects are simulated inside the
/// model, they never see the measured output. Parameters reach the hooks as plain numbers in the order of `parameters`.
class Effect {
 public:
  virtual ~Effect() = default;

  virtual std::string name() const = 0;
  virtual std::vector<Parameter> parameters() const = 0;
  /// Points from which the fit sets out.
  virtual std::vector<Eigen::VectorXd> starts(const Scales& scales) const = 0;
  /// Other effects that no experiment on this kind of plant tells apart from this one.
  virtual std::vector<std::string> equivalents() const { return {}; }
  /// What an experiment would need to tell the equivalents apart; "" without any.
  virtual std::string separation() const { return {}; }
  /// The effect with its values in words: "dead time of the inverter: 10.80 V (+-0.04) lost in the direction of the current".
  virtual std::string sentence(const Eigen::VectorXd& value, const Eigen::VectorXd& std, const Scales& scales) const = 0;

  /// Whether the model with it is still linear, and so known in closed form.
  virtual bool linear() const = 0;
  /// Whether it acts through extra_stored.
  virtual bool stores() const { return false; }
  /// Steps of the simulation for each sample of the input; its laws change within one.
  virtual int steps_per_sample() const { return 1; }

  /// Time by which the output comes late [s].
  virtual double delay_s(const double*) const { return 0.0; }
  /// What is lost of the effort (voltage, force) at that flow (current, velocity) over the coming step of the simulation. gain:
  /// by how much a unit of effort changes the flow in that step; a law that jumps is spread over what it can change itself, so
  /// that it stops the flow and does not make it chatter.
  virtual double effort_lost(const double*, double /*flow*/, double /*gain*/) const { return 0.0; }
  /// What is added to the stored quantity x in the law of the store, flow = (x + extra(x)) / L: magnetising current over flux,
  /// force over displacement.
  virtual Law extra_stored(const double*, double) const { return {}; }
};

/// An effect with the values of its parameters.
struct AddedEffect {
  const Effect* effect = nullptr;
  Eigen::VectorXd values;
};
using Extension = std::vector<AddedEffect>;

bool is_linear(const Extension& extension);
double delay_s(const Extension& extension);

}  // namespace bodeflow::residual
