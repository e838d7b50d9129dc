#include "model/place_scales.hpp"

#include <algorithm>
#include <cmath>

#include "model/plant_matrices.hpp"

namespace bodeflow::residual {
namespace {

/// The number k with which `by` times k comes nearest to `effect`.
double ratio(const Eigen::MatrixXd& effect, const Eigen::MatrixXd& by) {
  const double power = by.squaredNorm();
  return power > 0.0 ? effect.cwiseProduct(by).sum() / power : 0.0;
}

/// The linear coefficient of the plant at a place: what reaction over flow (stored) it has there already, w = k flow, from the
/// way in which w would act: A = E k Cf + ..., for a plant without states D = F k Df + ...
double coefficient(const PlantMatrices& p, Eigen::Index place, bool over_stored) {
  const Eigen::RowVectorXd seen =
      p.states() > 0 ? (over_stored ? p.Cs : p.Cf).row(place) : (over_stored ? p.Ds : p.Df).row(place);
  if (p.states() > 0) return std::abs(ratio(p.A, p.E.col(place) * seen));
  return std::abs(ratio(p.D, p.F.col(place) * seen));
}

double effort_of(const PlantMatrices& p, Eigen::Index place, double input_peak, double output_peak) {
  if (p.states() == 0) return p.F.col(place).norm() > 0.0 ? output_peak / p.F.col(place).norm() : output_peak;
  const double by_reaction = p.E.col(place).norm();
  return by_reaction > 0.0 ? input_peak * p.B.col(0).norm() / by_reaction : input_peak;
}

}  // namespace

void say_place(const JointModel& base, const Eigen::VectorXd& values, std::span<const double> known, const Eigen::MatrixXd& flow,
               const Eigen::MatrixXd& stored, std::size_t place, Situation& s) {
  const auto column = static_cast<Eigen::Index>(place);
  if (flow.cols() > column && flow.rows() > 0) {
    s.place.flow = std::max(s.place.flow, flow.col(column).cwiseAbs().maxCoeff());
    s.place.stored = std::max(s.place.stored, stored.col(column).cwiseAbs().maxCoeff());
  }
  const auto plant = plant_matrices(*base.base, values.data(), known);
  if (!plant) return;
  const std::string& kind = s.place.kind;
  const bool over_stored = kind == "spring" || kind == "coupling" || kind == "tank" || kind == "core";
  s.place.coefficient = coefficient(*plant, column, over_stored);
  s.place.effort = std::max(s.place.effort, effort_of(*plant, column, s.input_peak, s.output_peak));
}

}  // namespace bodeflow::residual
