#pragma once

#include <bodeflow/error.hpp>

#include "fit.hpp"

namespace bodeflow::sanathanan_koerner {

struct RefinementSettings {
  bool stable = true;  ///< no step to an unstable pole
  int steps = 50;
  double tolerance = 1e-10;  ///< relative fall of the squared error below which the search has converged
};

/// The model at the local minimum of the sum of |q (g - n/d)|^2 that lies downhill of `start`: nonlinear least squares, where the
/// Sanathanan-Koerner iteration only nears a fixed point that is no minimum. Its `course` has the error of each accepted step.
///
/// Method: Gauss-Newton with Levenberg-Marquardt damping in the denominator alone; the numerators are eliminated exactly
/// (variable projection, in Kaufman's form). No step takes a pole beyond a million times the highest frequency, where a state
/// space loses the model. The linear problem of a step is that of `fit` with the model's response in the place of the data. Cost
/// of a step: that of one iterate of `fit`, and a basis for each trial. Errors: those of arnoldi. Sources: G. Golub, V. Pereyra,
/// Separable nonlinear least squares, Inverse Problems 19, 2003, doi:10.1088/0266-5611/19/2/201; H. Akcay, S. M. Islam, B.
/// Ninness, section IV (the comparison with a Gauss-Newton refinement).
Expected<Fit> refined(const Data& data, const Fit& start, const RefinementSettings& settings);

}  // namespace bodeflow::sanathanan_koerner
