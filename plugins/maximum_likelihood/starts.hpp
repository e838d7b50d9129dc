#pragma once

#include <string>
#include <vector>

#include "fit.hpp"

namespace bodeflow::maximum_likelihood {

/// A model from which a search can begin.
struct Start {
  std::string name;
  Estimate estimate;
  double cost = 0.0;
};

/// Delays worth a search, the best first, at most three: local minima over a grid of eighths of a period of the highest line. The
/// delay of the structure where it is not estimated.
std::vector<double> promising_delays(const Lines& lines, const Structure& structure);

/// Starts of all linear methods at these delays, by cost; those that are alike are kept once.
std::vector<Start> linear_starts(const Lines& lines, const Structure& structure, const std::vector<double>& delays);

/// The model with these values of A and B (lines x outputs, without delay), in bases of their own; exact where the values are
/// those of polynomials of the structure's orders.
Expected<Estimate> estimate_with(const Lines& lines, const Structure& structure, const Eigen::VectorXcd& a,
                                 const Eigen::MatrixXcd& b, double delay_s);

/// The model with unstable poles at their mirror images, its magnitude kept; nothing where there are none.
std::vector<Start> reflected(const Fit& fit);

/// Models of one more pole and zero, close together, at some places of the band: a start for an order above that of `lower`.
std::vector<Start> grown(const Lines& lines, const Structure& structure, const Fit& lower);

}  // namespace bodeflow::maximum_likelihood
