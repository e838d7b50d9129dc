#include "model/plant_matrices.hpp"

#include <bodeflow/numerics/balance.hpp>

namespace bodeflow::residual {
namespace {

Eigen::MatrixXd matrix(const std::vector<double>& values, Eigen::Index rows, Eigen::Index columns) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(values.data(), rows, columns);
}

}  // namespace

std::optional<PlantMatrices> plant_matrices(const BaseModel& base, const double* values, std::span<const double> known) {
  LinearPlant plant;
  if (!base.has_state_space() || !base.state_space(values, known.data(), plant)) return {};
  const Eigen::Index n = plant.states, q = plant.inputs, m = plant.places;
  PlantMatrices p;
  p.A = matrix(plant.A, n, n);
  p.B = matrix(plant.B, n, q);
  p.E = matrix(plant.E, n, m);
  p.Cf = matrix(plant.Cf, m, n);
  p.Df = matrix(plant.Df, m, q);
  p.Ff = matrix(plant.Ff, m, m);
  p.Cs = matrix(plant.Cs, m, n);
  p.Ds = matrix(plant.Ds, m, q);
  p.Fs = matrix(plant.Fs, m, m);
  p.C = matrix(plant.C, 1, n);
  p.D = matrix(plant.D, 1, q);
  p.F = matrix(plant.F, 1, m);
  if (!p.A.allFinite() || !p.B.allFinite() || !p.E.allFinite() || !p.C.allFinite()) return {};
  p.scale = n > 0 ? numerics::balancing_scales(p.A) : Eigen::VectorXd();
  p.A = numerics::scaled_by(p.A, p.scale);
  p.B = p.scale.cwiseInverse().asDiagonal() * p.B;
  p.E = p.scale.cwiseInverse().asDiagonal() * p.E;
  p.C = p.C * p.scale.asDiagonal();
  p.Cf = p.Cf * p.scale.asDiagonal();
  p.Cs = p.Cs * p.scale.asDiagonal();
  return p;
}

}  // namespace bodeflow::residual
