#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "solution.hpp"

namespace bodeflow::koopmans_levin {

/// How far the parameters go when the noise ratio is wrong by a factor.
struct RatioSensitivity {
  double factor = 2.0;
  Eigen::VectorXd shift;              ///< of a_1 .. b_n: the greater of those at ratio / factor and ratio * factor, with its sign
  Eigen::VectorXd shift_in_std;       ///< its magnitude over the standard deviation
  std::vector<std::string> warnings;  ///< one a parameter that moves by more than one standard deviation
};

/// The shifts between parameters at a ratio `factor` smaller and greater and those at the ratio itself, `centre`, beside their
/// covariance.
RatioSensitivity ratio_sensitivity(const Eigen::VectorXd& centre, const Eigen::VectorXd& below, const Eigen::VectorXd& above,
                                   const Eigen::MatrixXd& covariance, double factor);

/// The solutions at a ratio `factor` smaller and greater, beside `covariance` (that of influence.hpp). Cost: two solutions.
/// Errors: those of `solve`; a factor that is not above 1.
Expected<RatioSensitivity> ratio_sensitivity(const Factors& factors, const Solution& solution, const Eigen::MatrixXd& covariance,
                                             double factor = 2.0);

}  // namespace bodeflow::koopmans_levin
