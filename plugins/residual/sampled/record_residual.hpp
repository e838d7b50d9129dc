#pragma once

#include <vector>

#include "sampled/layout.hpp"
#include "sampled/prediction.hpp"

namespace bodeflow::residual {

/// A record with its cut: what is measured, and what models leave of it.
struct SampledRecord {
  RecordInput input;
  Eigen::VectorXd output;  ///< at the samples
  Layout layout;

  /// The sample of each row.
  std::vector<Eigen::Index> row_samples() const;
  /// Those rows of a signal at the samples.
  Eigen::VectorXd rows_of(const Eigen::VectorXd& at_samples) const;
};

/// What a model makes of a record: the output at all samples from the first row of each segment's simulation on, and signals at
/// a place.
struct Predicted {
  Eigen::VectorXd output;        ///< at the samples
  Eigen::MatrixXd flow, stored;  ///< samples x places; empty where the model was not simulated
};

/// Each segment from the state that fits its window best; flow and stored where `signals`. Errors: those of Prediction.
Expected<Predicted> predict(const SampledRecord& record, const JointModel& model, const Eigen::VectorXd& values,
                            bool signals = false);

/// Measured minus predicted at the rows, amplitudes and phases of the model's tones fitted to it and taken off; not finite
/// where the model can't be computed.
Eigen::VectorXd unexplained(const SampledRecord& record, const JointModel& model, const Eigen::VectorXd& values);

}  // namespace bodeflow::residual
