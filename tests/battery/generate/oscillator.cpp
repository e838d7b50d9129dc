#include "generate/oscillator.hpp"

#include <cmath>
#include <numbers>

#include "generate/integrate.hpp"

namespace battery {

Oscillator Oscillator::draw(Random& random) {
  const double omega = 2.0 * std::numbers::pi * random.uniform(8.0, 12.0);
  Oscillator o;
  o.mass = random.log_uniform(0.5, 2.0);
  o.damping = 2.0 * random.uniform(0.015, 0.035) * omega * o.mass;
  o.stiffness = omega * omega * o.mass;
  o.force_rms = random.log_uniform(3.0, 30.0);
  return o;
}

std::vector<int> Oscillator::line_choice() const {
  std::vector<int> lines;  // of 0.0977 Hz: 0.5 to 30 Hz densely, on to 58 Hz
  for (int line = 5; line < 595; line += line < 307 ? 2 : 8) lines.push_back(line);
  return lines;
}

Series Oscillator::clean(const Drive& d) const {
  return integrate<2>(
      d, Between::smooth, {},
      [this](double, double f, const State<2>& x) {
        return State<2>{x[1], (f - damping * x[1] - stiffness * x[0]) / mass};
      },
      [](const State<2>& x) { return x[0]; });
}

Complex Oscillator::response(const std::vector<double>& parameters, double omega) const {
  return parameters[0] / Complex(parameters[2] - omega * omega, parameters[1] * omega);
}

}  // namespace battery
