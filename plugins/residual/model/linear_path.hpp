#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <span>

#include "model/joint_model.hpp"
#include "model/modes.hpp"
#include "model/plant_matrices.hpp"

namespace bodeflow::residual {

/// The linear part of a joint model at one set of values, for many frequencies; for one thread.
class LinearPath {
 public:
  /// The model has to live as long.
  LinearPath(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known);

  /// The plant as a state space; nothing outside of the domain, or where the model has none.
  const std::optional<PlantMatrices>& matrices() const { return plant_; }
  const std::optional<Modes>& modes() const { return modes_; }
  Eigen::Index inputs() const;
  /// No immittance, series or parallel effect: the plant and a delay are all.
  bool bare() const { return bare_; }

  /// (1 + places) x (inputs + places): the plant alone.
  void plant(std::complex<double> s, Eigen::MatrixXcd& g) const;
  /// 1 x inputs each, without delay: `plain` the plant alone, `joint` = (plant with immittances + parallel) series.
  void responses(std::complex<double> s, Eigen::RowVectorXcd& plain, Eigen::RowVectorXcd& joint) const;
  /// What the immittances of each place add up to.
  Eigen::VectorXcd immittances(std::complex<double> s) const;
  /// The product of the series effects.
  std::complex<double> series(std::complex<double> s) const;
  /// The sum of the parallel effects.
  std::complex<double> parallel(std::complex<double> s) const;

 private:
  void seen(std::complex<double> s) const;

  const JointModel& model_;
  const Eigen::VectorXd& values_;
  std::span<const double> known_;
  std::optional<PlantMatrices> plant_;
  std::optional<Modes> modes_;
  std::vector<Eigen::Index> immittance_places_;
  /// Of the output and the flows with immittances, by inputs and reactions there.
  Resolvent resolvent_;
  Eigen::MatrixXd direct_;
  mutable Eigen::MatrixXcd g_;
  bool bare_ = true;
};

}  // namespace bodeflow::residual
