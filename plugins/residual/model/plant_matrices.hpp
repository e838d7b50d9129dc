#pragma once

#include <Eigen/Core>
#include <bodeflow/base_model.hpp>
#include <optional>
#include <span>

namespace bodeflow::residual {

/// A LinearPlant with its states scaled by powers of two, so that A is balanced (x = scale .* x').
struct PlantMatrices {
  Eigen::MatrixXd A, B, E, Cf, Df, Ff, Cs, Ds, Fs, C, D, F;
  Eigen::VectorXd scale;

  Eigen::Index states() const { return A.rows(); }
  Eigen::Index inputs() const { return D.cols(); }
  Eigen::Index places() const { return F.cols(); }
};

/// The plant at these values; nothing outside of the domain, or where the model has no state space.
std::optional<PlantMatrices> plant_matrices(const BaseModel& base, const double* values, std::span<const double> known);

}  // namespace bodeflow::residual
