#pragma once

#include <Eigen/Core>

/// What the residual of a response tells, line by line. A residual has its lines one after the other for each input in turn, real
/// and imaginary part of each.
namespace bodeflow::residual {

/// The probability of so large a residual where each line's variance is an estimate with nu complex degrees of freedom
/// (infinite: known): sum 2 nu ln(1 + |r_k|^2 / (2 nu)) over the lines is chi-squared with 2 degrees of freedom a line, for
/// |r_k|^2 / 2 is F(2, 2 nu) distributed, whose tail is (1 + x / nu)^-nu. `fitted`: parameters that the residual has lost.
/// `correlated`: neighbours on each side whose errors a line shares; the sum then counts as that of lines / (2 correlated + 1).
double lines_tail(const Eigen::VectorXd& residual, double nu, double fitted, double correlated);

/// The probability of so much likeness between neighbouring lines of each input, one-sided: sum_k r_k . r_k+1 over the root of
/// the sum of its squares, a standard normal deviate for independent circular errors.
double likeness_tail(const Eigen::VectorXd& residual, Eigen::Index inputs);

/// The length over which neighbouring lines err alike: 1 + 2 sum of the autocorrelations up to the first below 0 (C. J. Geyer,
/// Practical Markov chain Monte Carlo, Statistical Science 7, 1992), between 1 and a quarter of the lines.
double likeness_length(const Eigen::VectorXd& residual, Eigen::Index inputs);

/// Mean over its standard deviation of the falls of |r|^2 by blocks of neighbouring lines, about 20 of all inputs together.
double block_deviate(const Eigen::VectorXd& before, const Eigen::VectorXd& after, Eigen::Index inputs);

}  // namespace bodeflow::residual
