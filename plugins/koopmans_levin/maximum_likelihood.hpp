#pragma once

#include <Eigen/Core>
#include <string>

#include "solution.hpp"

namespace bodeflow::koopmans_levin {

/// A model refined by maximum likelihood.
struct RefinedModel {
  Model model;
  Eigen::MatrixXd covariance;  ///< of a_1 .. a_n, b_0 .. b_n
  double cost = 0.0;           ///< sum w |eps|^2 / (ratio |A|^2 + |B|^2): expected lambda_u (equations - parameters) / 2
  bool converged = false;
  std::string reason;  ///< why the search ended
};

/// The maximum likelihood estimate for normal white noises of known variance ratio, from `start`:
///   min sum_k w_k |A Y - B U - T|^2 / (ratio |A|^2 + |B|^2)  over a, b, tau,
/// the noise-free spectra at every line being unknowns of their own. Levenberg-Marquardt with exact derivatives.
///
/// Covariance: inverse Hessian, times the sum of the lines' squared gradients, times inverse Hessian. The usual inverse of J^T J
/// is too small here (at 10 dB by a tenth in variance): the regressors carry noise. Consistent; in the paper's Example 1 the
/// variances of a_2 and b_2 are half those of the Koopmans-Levin estimate. A local minimum only: start from that estimate.
/// Errors: a start without transient; those of levenberg_marquardt; a Hessian that is not positive definite.
Expected<RefinedModel> maximum_likelihood(const Lines& lines, const Model& start);

}  // namespace bodeflow::koopmans_levin
