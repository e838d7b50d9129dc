#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <optional>

#include "data.hpp"

namespace bodeflow::sanathanan_koerner {

/// How many states a model of several inputs and outputs may keep.
struct States {
  bool reduce = false;
  std::optional<Eigen::Index> count;  ///< nothing: as few as change the response by less than half the fit's error
};

/// A model with fewer states than poles times the smaller number of inputs and outputs.
struct Reduction {
  numerics::StateSpace system;
  Eigen::VectorXcd poles;
  Eigen::MatrixXcd response;               ///< at the lines, columns stacked
  Eigen::VectorXd hankel_singular_values;  ///< of the model before, in falling order
  double error_bound = 0.0;                ///< of the largest change of the response over frequency
  double rms_change = 0.0;                 ///< of the response over lines and channels
  double relative_error = 0.0;             ///< weighted residual of the reduced model over the weighted data

  /// The last Hankel singular value that is kept over the first that is not: large where the number of states is beyond doubt.
  /// Infinite where all are kept.
  double gap() const;
};

/// The balanced truncation of a fitted model.
///
/// Method: numerics::balanced_truncation, whose Hankel singular values are exact to the rounding of the largest: a common
/// denominator whose residues have a lower rank leaves a gap there. Where the count is open, the fewest states that change the
/// response at the lines, in their weights, by no more than half the error of the fit: the error grows by some 12 %.
/// response: of `full` at the lines. Errors: a model that is not stable; more states than it has.
Expected<Reduction> reduced_states(const Data& data, const numerics::StateSpace& full, const Eigen::MatrixXcd& response,
                                   const States& states);

}  // namespace bodeflow::sanathanan_koerner
