#pragma once

#include <Eigen/Core>

#include "periodic/floor_of_bins.hpp"

namespace bodeflow::residual {

/// The floor of the bins of a record in which lines may change their size in proportion to time (a drift), which raises the bins
/// between dense lines all over. nothing where the periods are fewer than 4.
///
/// Method: the Fourier coefficients of a line in each of the P periods, projected on the orthogonal polynomials of degree 2 .. P
/// - 1 over the period's number: noise alone where the line is steady or grows evenly, independent and as large as in a bin of
/// the whole record. Leakage of evenly growing lines into others is the same in every period, and so of degree 0. `samples`:
/// periods x period, one after the other. `lines`: how many, from 0; line 0 is left out.
Expected<FloorOfBins> drift_free_floor(const Eigen::VectorXd& samples, Eigen::Index periods, Eigen::Index lines, double line_hz);

/// Which of two floors a record has: the drift-free one where that of all bins is higher by more than chance makes it.
const FloorOfBins& lower_floor(const FloorOfBins& of_bins, const FloorOfBins& drift_free, const Eigen::VectorXd& frequency_hz);

}  // namespace bodeflow::residual
