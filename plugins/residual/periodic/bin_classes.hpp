#pragma once

#include <vector>

#include "periodic/periodic_record.hpp"
#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// Tests of a whitened residual by class of bins: at the excited lines (what is linear and not in the model), at the odd and the
/// even unexcited ones (odd and even nonlinearity), at zero frequency (offset), beside the excited lines (drift), at all other
/// bins between (noise that comes and goes), and the highest peak between the lines (tones). Classes without bins are left out.
///
/// Method: with r the residual and J its Jacobian, in a fitted record r'r has the degrees of freedom that the fit leaves, rows -
/// trace(J C J'); in one that was not fitted r'(I + J C J')^-1 r has all of them, C the covariance of the parameters. The noise
/// floor of the class has 2 / variance degrees of freedom, so the ratio is F distributed. Bins between the lines are what the
/// floor is made from, so their mean over it scatters less. Peak of m bins: p = 1 - exp(-m e^-x), in the mean over
/// the floor's error. Reference: R. Pintelon, J.
/// Schoukens, System Identification, 2nd ed. 2012, sections 4.3 and 11.3.
std::vector<ClassTest> test_bins(const PeriodicRecord& record, const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                                 const Eigen::MatrixXd& covariance, bool fitted);

}  // namespace bodeflow::residual
