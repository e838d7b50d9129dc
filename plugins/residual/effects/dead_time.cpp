#include "dead_time.hpp"

#include <cmath>

#include "records/signals.hpp"

namespace bodeflow::residual {

std::vector<Parameter> DeadTime::parameters() const {
  return {{"dead_time_voltage", "V", 0.0, 1e4, true, 1.0}, {"dead_time_width", "A", 0.0, 1e4, true, 1.0}};
}

std::vector<Eigen::VectorXd> DeadTime::starts(const Scales& scales) const {
  return {Eigen::Vector2d(0.2 * scales.effort, 0.01 * scales.flow)};
}

std::string DeadTime::sentence(const Eigen::VectorXd& value, const Eigen::VectorXd& std, const Scales&) const {
  return "dead time of the inverter, " + records::short_number(value[0], 4) + " V (+-" + records::short_number(std[0], 2) +
         ") lost against the current";
}

Law DeadTime::effort_lost(const double* p, double current) const {
  if (std::abs(current) < p[1]) return {p[0] * current / p[1], p[0] / p[1]};
  return {std::copysign(p[0], current), 0.0};
}

}  // namespace bodeflow::residual
