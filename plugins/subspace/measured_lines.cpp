#include "measured_lines.hpp"

#include <string>

namespace bodeflow::subspace {

Expected<Lines> lines_of(const Measured& measured, Weighting weighting) {
  const auto outputs = static_cast<Eigen::Index>(measured.outputs.names.size());
  Lines lines{measured.data.omega_rad_s, measured.data.response, outputs, Eigen::VectorXd::Ones(measured.data.lines())};
  const Eigen::VectorXd deviation =
      measured.deviation.size() > 0 ? Eigen::VectorXd(measured.deviation.rowwise().norm()) : Eigen::VectorXd();
  const bool certain = deviation.size() > 0 && deviation.minCoeff() > 0.0;
  if (weighting == Weighting::automatic) weighting = certain ? Weighting::variance : Weighting::absolute;
  if (weighting == Weighting::relative) {
    auto weight = relative_weights(lines);
    if (!weight) return unexpected(weight.error().text);
    lines.weight = std::move(*weight);
  }
  if (weighting == Weighting::variance) {
    if (deviation.size() == 0) return unexpected("weighting: variance needs a response with its variance; this one has none");
    if (!certain) return unexpected("weighting: variance, and the variance of a line is zero: take weighting: absolute");
    lines.weight = deviation.cwiseInverse();
  }
  // Only their ratios count; a mean of 1 keeps sums in range.
  lines.weight /= lines.weight.mean();
  return lines;
}

}  // namespace bodeflow::subspace
