#pragma once

#include <Eigen/Core>

namespace bodeflow::residual {

/// The power |Y|^2 at the bins between the lines, for the noise floor: tones are taken out that stand so high above it that what
/// they leak would raise it. `bins`: Fourier coefficients 0 ... of `periods` periods, `samples`
/// in all; those of lines are not looked at. As many values as there are bins between the lines, in their order.
///
/// Method: the highest bin first; frequency and amplitude are fitted to the bins beside it, the tone is taken off all, and the
/// next highest follows (J. A. Hogbom, Aperture synthesis with a non-regular distribution of interferometer baselines, Astron.
/// Astrophys. Suppl. 15 (1974) 417).
Eigen::VectorXd tone_free_power(const Eigen::VectorXcd& bins, Eigen::Index periods, Eigen::Index samples);

}  // namespace bodeflow::residual
