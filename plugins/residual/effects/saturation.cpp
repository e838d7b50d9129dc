#include "saturation.hpp"

#include <limits>

#include "records/signals.hpp"

namespace bodeflow::residual {

std::vector<Parameter> Saturation::parameters() const {
  constexpr double kNoBound = std::numeric_limits<double>::infinity();
  return {{"saturation_cubic", "1/(V s)^2", 0.0, kNoBound, false, 1.0},
          {"saturation_bend", "1/(V s)^2", -kNoBound, kNoBound, false, 1.0}};
}

std::vector<Eigen::VectorXd> Saturation::starts(const Scales& scales) const {
  const double square = scales.stored * scales.stored;
  return {Eigen::Vector2d(1.0 / square, 0.0)};
}

Law Saturation::extra_stored(const double* p, double flux) const {
  const double square = flux * flux, bend = p[1] * square, part = 1.0 / (1.0 + bend), rise = p[0] * square * part;
  return {rise * flux, rise * (3.0 + bend) * part};
}

std::string Saturation::sentence(const Eigen::VectorXd& value, const Eigen::VectorXd&, const Scales& scales) const {
  const double fall = 1.0 - 1.0 / (1.0 + extra_stored(value.data(), scales.stored).slope);
  return "saturation of the main flux: the incremental inductance falls by " + records::short_number(100.0 * fall, 2) +
         " % up to the largest flux of the records, " + records::short_number(scales.stored, 2) + " V s";
}

}  // namespace bodeflow::residual
