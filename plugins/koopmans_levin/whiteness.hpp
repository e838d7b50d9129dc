#pragma once

#include <Eigen/Core>

#include "solution.hpp"

namespace bodeflow::koopmans_levin {

/// Whether the equation errors are as large at every frequency as white noises of the estimated variances make them.
struct Whiteness {
  double statistic = 0.0;           ///< S = sum_b L_b (m_b - 1)^2
  double degrees_of_freedom = 0.0;  ///< bands - 1
  double probability = 1.0;         ///< of a greater S where all assumptions hold
  Eigen::VectorXd band_mean;        ///< m_b, 1 where the noise is as assumed
  Eigen::VectorXd band_omega;       ///< middle of each band, rad/sample
};

/// The test of |A Y - B U - T|^2 / (lambda_y |A|^2 + lambda_u |B|^2) by bands of neighbouring lines, the mean over all scaled to
/// 1: under white noise S is chi-squared with bands - 1 degrees of freedom. Where it fails: noise that is coloured, a wrong
/// ratio, an order too low; which of them it does not say, `band_mean` shows where. It sees a wrong ratio weakly (a factor 2 at
/// 1000 samples: one time in eight at 1 %). Lines 0 and N/2, where spectra are real, are left out. Errors: fewer than 2 bands,
/// fewer than 5 lines a band.
Expected<Whiteness> whiteness(const Lines& lines, const Model& model, Eigen::Index bands = 20);

}  // namespace bodeflow::koopmans_levin
