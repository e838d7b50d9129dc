#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <bodeflow/numerics/linear_system.hpp>
#include <optional>

#include "data.hpp"
#include "partial_fractions.hpp"

namespace bodeflow::sanathanan_koerner {

/// How many states a model of several inputs and outputs may keep.
struct States {
  bool reduce = false;
  bool by_residues = false;           ///< Gilbert's realisation in place of a balanced truncation
  std::optional<Eigen::Index> count;  ///< nothing: as few as change the response by less than half the fit's error
};

/// A model with fewer states than poles times the smaller number of inputs and outputs.
struct Reduction {
  numerics::StateSpace system;
  Eigen::VectorXcd poles;
  Eigen::MatrixXcd response;  ///< at the lines, columns stacked
  Eigen::Index states_before = 0;
  Eigen::VectorXd hankel_singular_values;  ///< of the model before, in falling order; empty of Gilbert's realisation
  double error_bound = 0.0;                ///< of the largest change of the response over frequency, by balanced truncation
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

/// Gilbert's realisation of a model in partial fractions, whose residues may have a lower rank than inputs and outputs allow.
///
/// Method: numerics::gilbert_realisation with residues by least squares; of the tolerances 0.1, 0.01, .. for their singular
/// values the largest whose change of the response at the lines, in their weights, is no more than half the error of the fit. All
/// poles stay. response: of the fit at the lines; inputs: the channels are that many columns. Errors: those of fit_residues; no
/// tolerance is small enough.
Expected<Reduction> gilbert_states(const Data& data, const PartialFractions& model, const Eigen::MatrixXcd& response,
                                   Eigen::Index inputs);

}  // namespace bodeflow::sanathanan_koerner
