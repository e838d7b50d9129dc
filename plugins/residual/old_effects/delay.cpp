#include "delay.hpp"

#include "records/signals.hpp"

namespace bodeflow::residual {

std::vector<Parameter> Delay::parameters() const { return {{"delay", "s", 0.0, 1.0, false, 1e-3}}; }

std::vector<Eigen::VectorXd> Delay::starts(const Scales&) const { return {Eigen::VectorXd::Zero(1)}; }

std::string Delay::sentence(const Eigen::VectorXd& value, const Eigen::VectorXd& std, const Scales&) const {
  return "delay of " + records::short_number(1e6 * value[0], 4) + " us (+-" + records::short_number(1e6 * std[0], 2) +
         ") that is not declared";
}

std::string Delay::separation() const {
  return "put a resistor in the place of the motor: a delay of the drive stays, a skin effect of the rotor does not";
}

}  // namespace bodeflow::residual
