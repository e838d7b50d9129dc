#pragma once

#include "model/linear_path.hpp"
#include "model/sampled_plant.hpp"

namespace bodeflow::residual {

/// The linear part of a joint model from samples to samples: behind the hold that the base model declares.
class SampledPath {
 public:
  /// The model and the values have to live as long.
  SampledPath(const JointModel& model, const Eigen::VectorXd& values, std::span<const double> known, double sample_time_s);

  /// 1 x inputs, by the samples of the input, delays included.
  ///
  /// Band-limited inputs: the response itself. Held ones: the plant exactly (modified z-transform, E. I. Jury, Theory and
  /// Application of the z-Transform Method, 1964); what effects change is added alias by alias, and beyond the last in the ratio
  /// that they have there.
  Eigen::RowVectorXcd at(double frequency_hz) const;
  const LinearPath& path() const { return path_; }

 private:
  LinearPath path_;
  Hold hold_;
  double sample_time_s_, delay_s_;
  std::optional<SampledPlant> exact_;
  mutable Eigen::RowVectorXcd plain_, joint_;
};

}  // namespace bodeflow::residual
