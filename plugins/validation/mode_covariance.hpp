#pragma once

#include <Eigen/Core>
#include <bodeflow/error.hpp>
#include <complex>
#include <vector>

#include "sanathanan_koerner/data.hpp"

namespace bodeflow::validation {

/// The covariance of real and imaginary part of each of those poles, all of the model's being `poles`.
///
/// Method: inverse of J'J for the slopes of the weighted response by these poles, with all else that was estimated projected out:
/// residues, constant, other poles. Parameters among the latter that the data do not tell apart, as of a pole far beyond the
/// lines, do no harm. data: one response with weights 1 over its standard deviation.
/// Errors: poles without conjugates, residues that can't be found, poles of the list that the data do not tell apart.
Expected<std::vector<Eigen::Matrix2d>> mode_covariances(const sanathanan_koerner::Data& data, const Eigen::VectorXcd& poles,
                                                        const std::vector<std::complex<double>>& wanted);

}  // namespace bodeflow::validation
