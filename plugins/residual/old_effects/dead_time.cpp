#include "dead_time.hpp"

#include <algorithm>

#include "records/signals.hpp"

namespace bodeflow::residual {

std::vector<Parameter> DeadTime::parameters() const {
  return {{"dead_time_voltage", "V", 0.0, 1e4, true, 1.0}, {"dead_time_width", "A", 0.0, 1e4, true, 1.0}};
}

std::vector<Eigen::VectorXd> DeadTime::starts(const Scales& scales) const {
  std::vector<Eigen::VectorXd> starts;
  for (const double share : {0.05, 0.1, 0.2, 0.3, 0.45, 0.6})
    starts.push_back(Eigen::Vector2d(share * scales.effort, 0.01 * scales.flow));
  return starts;
}

std::string DeadTime::sentence(const Eigen::VectorXd& value, const Eigen::VectorXd& std, const Scales&) const {
  return "dead time of the inverter, " + records::short_number(value[0], 4) + " V (+-" + records::short_number(std[0], 2) +
         ") lost against the current";
}

double DeadTime::effort_lost(const double* p, double current, double gain) const {
  return p[0] * std::clamp(current / (p[1] + gain * p[0]), -1.0, 1.0);
}

}  // namespace bodeflow::residual
