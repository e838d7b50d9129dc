#pragma once

#include <vector>

#include "rational.hpp"

namespace bodeflow::maximum_likelihood {

/// (1 - exp(-s T)) / (s T) at a frequency: what a hold does to a signal, its images left aside.
std::complex<double> hold_factor(double omega_rad_s, double sample_time_s);

/// What the images of a held input add at the sample times, lines x outputs: G_held - hold_factor * G, G_held the exact response
/// between samples (numerics::zero_order_hold). Errors: those of zero_order_hold and of the cascade of poles and zeros.
Expected<Eigen::MatrixXcd> images(const Eigen::VectorXd& omega_rad_s, double sample_time_s, const std::vector<Rational>& models);

/// `spectra` as they would be without hold, for a model whose images are known: Y - images U for Y, hold_factor U for U, output
/// by output.
void remove_hold(Lines& lines, const Spectra& spectra, const Structure& structure, const Eigen::MatrixXcd& images);

}  // namespace bodeflow::maximum_likelihood
