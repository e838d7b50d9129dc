#pragma once

#include <string>
#include <vector>

#include "joint_fit.hpp"

namespace bodeflow::residual {

/// What is left in one class of lines, beside the noise.
struct ClassTest {
  std::string name;       ///< excited, odd, even, dc, skirts, peak
  double multiple = 0.0;  ///< root mean square of the residual over that of the noise
  double p = 1.0;         ///< probability of so much, or more, from noise alone
};

/// Tests of the residual of one experiment by class: at the excited lines (what is linear and not in the model), at the odd and
/// the even unexcited ones (odd and even nonlinearity), at zero frequency (offset), beside the excited lines (drift), and the
/// highest peak between the lines (tones). Classes without lines are left out.
///
/// Method: with r the whitened residual and J its Jacobian, in a fitted experiment r'r has the degrees of freedom that the fit
/// leaves, rows - trace(J C J'); in one that was not fitted r'(I + J C J')^-1 r has all of them, C the covariance of the
/// parameters. The noise floor of the class has 2 / variance degrees of freedom, so the ratio is F distributed. Peak of m bins: p
/// = 1 - (1 - e^-x)^m. Reference: R. Pintelon, J. Schoukens, System Identification, 2nd ed. 2012, sections 4.3 and 11.3.
std::vector<ClassTest> test_classes(const Experiment& experiment, const Prediction& prediction,
                                    const Eigen::MatrixXd& coordinate_covariance, bool fitted);

}  // namespace bodeflow::residual
