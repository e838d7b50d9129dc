#include "saturation.hpp"

#include <limits>

#include "records/signals.hpp"

namespace bodeflow::residual {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

}  // namespace

std::vector<Parameter> Saturation::parameters() const {
  return {{"saturation_a", "1/(V s)^2", 0.0, kNoBound, true, 1.0},
          {"saturation_b", "1/(V s)^4", 0.0, kNoBound, true, 1.0},
          {"saturation_c", "1/(V s)^4", 0.0, kNoBound, true, 1.0}};
}

std::vector<Eigen::VectorXd> Saturation::starts(const Scales& scales) const {
  const double square = scales.stored * scales.stored;
  std::vector<Eigen::VectorXd> starts;
  for (const double rise : {0.1, 0.4, 1.6})
    starts.push_back(Eigen::Vector3d(rise / square, rise / (square * square), 0.1 / (square * square)));
  return starts;
}

Law Saturation::extra_stored(const double* p, double flux) const {
  const double x = flux * flux, rise = x * (p[0] + x * p[1]), part = 1.0 / (1.0 + p[2] * x * x);
  const double slope = x * (2.0 * p[0] + x * (4.0 * p[1] - 2.0 * p[0] * p[2] * x)) * part * part;  // of the fraction, times flux
  return {flux * rise * part, rise * part + slope};
}

std::string Saturation::sentence(const Eigen::VectorXd& value, const Eigen::VectorXd&, const Scales& scales) const {
  const double fall = 1.0 - 1.0 / (1.0 + extra_stored(value.data(), scales.stored).slope);
  return "saturation of the main flux: the incremental inductance falls by " + records::short_number(100.0 * fall, 2) +
         " % up to the largest flux of the records, " + records::short_number(scales.stored, 2) + " V s";
}

}  // namespace bodeflow::residual
