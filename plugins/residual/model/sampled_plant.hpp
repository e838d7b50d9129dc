#pragma once

#include <complex>

#include "model/modes.hpp"
#include "model/plant_matrices.hpp"
#include "model/sample_delay.hpp"
#include "model/transition.hpp"

namespace bodeflow::residual {

/// A linear plant behind a hold, sampled: exact at the samples, aliases included.
class SampledPlant {
 public:
  /// `modes`: of the plant's A. `straight`: the input is straight from sample to sample, else held. `values_per_sample`: the hold
  /// works so many times a sample, on the values of `refined`.
  SampledPlant(const PlantMatrices& plant, const std::optional<Modes>& modes, bool straight, double sample_time_s, double delay_s,
               int values_per_sample = 1);

  /// 1 x inputs at f; not finite where the plant integrates and f is 0. With several values a sample: by the input that was
  /// refined.
  Eigen::RowVectorXcd at(double frequency_hz) const;

 private:
  Eigen::RowVectorXd by_begin_, by_end_;
  Resolvent from_begin_, from_end_;
  bool straight_;
  double hold_s_;
  Eigen::Index late_;
};

}  // namespace bodeflow::residual
