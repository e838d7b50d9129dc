#pragma once

#include <vector>

#include "periodic/periodic_record.hpp"

namespace bodeflow::residual {

/// Sinusoids of the output that the input does not make, taken out of a residual: amplitude and phase of each are fitted to all
/// bins, those of the lines included.
///
/// A tone on a line of the period shows at no bin between and is left: there it can't be told from what a nonlinearity makes.
class Tones {
 public:
  Tones(const PeriodicRecord& record, const JointModel& model, const Eigen::VectorXd& values);

  /// Amplitudes and phases that are fitted: 2 a tone.
  Eigen::Index fitted() const { return columns_.cols(); }
  /// The whitened residual without the tones.
  Eigen::VectorXd taken_out(const Eigen::VectorXd& residual) const;

 private:
  const PeriodicRecord& record_;
  Eigen::MatrixXd columns_;  ///< whitened: rows of the residual x 2 a tone
};

}  // namespace bodeflow::residual
