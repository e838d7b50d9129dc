#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>

#include "sanathanan_koerner/plane.hpp"

namespace bodeflow::subspace {

using sanathanan_koerner::Plane;

/// A frequency response that is fitted: lines in rows, entries in columns; the entry from input i to output o stands in column
/// i * outputs + o.
struct Lines {
  Eigen::VectorXd omega_rad_s;  ///< rises
  Eigen::MatrixXcd response;
  Eigen::Index outputs = 1;
  Eigen::VectorXd weight;  ///< of a line's residual, above 0

  Eigen::Index size() const { return omega_rad_s.size(); }
  Eigen::Index inputs() const { return response.cols() / outputs; }
  /// G of a line, outputs x inputs.
  Eigen::MatrixXcd at(Eigen::Index line) const { return response.row(line).reshaped(outputs, inputs()); }
};

/// Nothing. Errors, by name: no lines, sizes that do not fit, values that are not finite, frequencies below 0 or that do not rise
/// (or, in discrete time, are above half the sample rate), a response that is zero everywhere, weights that are not above 0.
Expected<void> check(const Lines& lines, const Plane& plane);

/// The largest count q of basis functions for so many lines: 2 lines inputs >= q (inputs + outputs), so that the rows are
/// independent.
Eigen::Index most_functions(const Lines& lines);

/// Weights 1 / |G| (Frobenius norm of a line), which make the fit one of relative errors. Error: a line whose response is zero.
Expected<Eigen::VectorXd> relative_weights(const Lines& lines);

/// Every second line from the first (part 0) or the second (part 1) on.
Lines every_second(const Lines& lines, Eigen::Index part);

}  // namespace bodeflow::subspace
