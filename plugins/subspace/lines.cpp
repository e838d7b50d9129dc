#include "lines.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "records/signals.hpp"

namespace bodeflow::subspace {
namespace {

std::string hertz(double omega_rad_s) { return records::short_number(omega_rad_s / (2.0 * std::numbers::pi)) + " Hz"; }

}  // namespace

Expected<void> check(const Lines& lines, const Plane& plane) {
  const Eigen::Index size = lines.size();
  if (size == 0) return unexpected("the response has no lines");
  if (lines.outputs < 1 || lines.response.rows() != size || lines.response.cols() == 0 || lines.response.cols() % lines.outputs)
    return unexpected("the response is " + std::to_string(lines.response.rows()) + " x " + std::to_string(lines.response.cols()) +
                      " for " + std::to_string(size) + " lines and " + std::to_string(lines.outputs) + " outputs");
  if (lines.weight.size() != size)
    return unexpected(std::to_string(lines.weight.size()) + " weights for " + std::to_string(size) + " lines");
  for (Eigen::Index k = 0; k < size; ++k) {
    const double omega = lines.omega_rad_s[k];
    if (!std::isfinite(omega) || omega < 0.0)
      return unexpected("the frequency of line " + std::to_string(k + 1) + " is not a finite number from 0");
    if (k > 0 && !(omega > lines.omega_rad_s[k - 1]))
      return unexpected("the frequencies do not rise: " + hertz(omega) + " after " + hertz(lines.omega_rad_s[k - 1]));
    if (plane.discrete() && omega * plane.sample_time_s > std::numbers::pi * (1.0 + 1e-9))
      return unexpected("the line at " + hertz(omega) + " is above half the sample rate");
    if (!lines.response.row(k).allFinite()) return unexpected("the response at " + hertz(omega) + " is not finite");
    if (!(lines.weight[k] > 0.0) || !std::isfinite(lines.weight[k]))
      return unexpected("the weight at " + hertz(omega) + " is not a finite number above 0");
  }
  if (lines.response.isZero(0.0)) return unexpected("the response is zero at every line");
  return {};
}

Eigen::Index most_functions(const Lines& lines) { return 2 * lines.size() * lines.inputs() / (lines.inputs() + lines.outputs); }

Expected<Eigen::VectorXd> relative_weights(const Lines& lines) {
  Eigen::VectorXd weight = lines.response.rowwise().norm();
  for (Eigen::Index k = 0; k < weight.size(); ++k) {
    if (!(weight[k] > 0.0))
      return unexpected("the response at " + hertz(lines.omega_rad_s[k]) + " is zero: it has no relative error");
    weight[k] = 1.0 / weight[k];
  }
  return weight;
}

Lines every_second(const Lines& lines, Eigen::Index part) {
  const Eigen::Index size = (lines.size() - part + 1) / 2;
  const auto rows = Eigen::seqN(part, size, 2);
  return {lines.omega_rad_s(rows), lines.response(rows, Eigen::all), lines.outputs, lines.weight(rows)};
}

}  // namespace bodeflow::subspace
