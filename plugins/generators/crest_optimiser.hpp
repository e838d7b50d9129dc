#pragma once

#include <span>
#include <vector>

#include "multisine.hpp"

namespace bodeflow::generators {

/// Points that `optimise_phases` computes for one signal, where the first descent does not take more: below a second's work.
inline constexpr std::size_t kOptimiserPoints = 4'000'000;

/// Points that the first descent may take.
std::size_t descent_points(std::span<const Line> lines);

/// Phases [rad] of `lines`, in [-pi, pi], whose signal has a low peak; it starts from the phases that the lines have.
///
/// Method: the p-norm of the signal, which tends to its peak as p grows, is minimised over the phases for p = 4, 8, ... 512 in
/// turn (Guillaume et al. 1991), by limited-memory BFGS steps in place of Gauss-Newton ones, so that a step costs two Fourier
/// sums and a thousand lines are no matter. That ends in a local minimum; as long as `points` last, the best phases are
/// disturbed and the descent begins again. Twelve points and more of each period of the highest line are looked at, so the peak
/// is low between the samples as well. Flat lines from the first on reach 1.39, a band of an octave 1.55. The work is bounded and
/// the operations are portable: the same bits on every machine. At least one line; amplitudes may not all be zero. Reference: P.
/// Guillaume, J. Schoukens, R. Pintelon, I. Kollar, "Crest-factor minimization using nonlinear Chebyshev approximation methods",
/// IEEE Trans. Instrum. Meas. 40, 1991, doi:10.1109/19.119778.
std::vector<double> optimise_phases(std::span<const Line> lines, std::size_t points = kOptimiserPoints);

}  // namespace bodeflow::generators
