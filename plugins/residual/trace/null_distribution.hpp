#pragma once

#include <Eigen/Core>
#include <vector>

#include "trace/looks.hpp"

namespace bodeflow::residual {

/// What an effect gains on the fitted records where it is not there.
struct Null {
  double freedom = 1.0;                  ///< parameters that count: those at which the effect vanishes, own ones once a record
  bool one_sided = false;                ///< half of the chance findings have the wrong sign
  double trials = 1.0;                   ///< independent places in which the search could find something
  bool tone = false;                     ///< trials grow with the square root of the gain, as a frequency is no bin
  std::vector<Eigen::Index> amplitudes;  ///< of the effect's parameters those at which it vanishes
  std::vector<double> simulated;         ///< gains of simulated nulls, in rising order; empty where one trial is all there is

  /// Values of the effect's parameters where a linear look at the residual finds most, best first.
  std::vector<Eigen::VectorXd> starts;
  double most = 0.0;        ///< what it finds there
  bool looked = false;      ///< there was such a look
  double opposite = 0.0;    ///< what it finds where the only direction there is has the wrong sign
  Eigen::VectorXd nearest;  ///< where it finds most, next to nothing if that is nowhere

  /// The probability of so much gain, or more.
  double p(double gain) const;
  /// That of what the look found.
  double p_of_look() const;
};

/// Simulates it for the effect that was added last, `from` the fit without it; `starts` and `found` are values of its parameters.
///
/// Method: an effect vanishes where one of its parameters (or all that may be 0 together) goes to 0; there its gain is
/// chi-squared with as many degrees of freedom, one half of which is at 0 where the bound forbids the other sign (H. Chernoff, On
/// the distribution of the likelihood ratio, Ann. Math. Stat. 25 (1954) 573). Its other parameters say nothing there, and the
/// search over them takes the largest of many such gains (R. B. Davies, Hypothesis testing when a nuisance parameter is present
/// only under the alternative, Biometrika 74 (1987) 33). Its Jacobian on a grid of these parameters, at right angles to that of
/// the model without it, gives the scores: normal with that Gram matrix; 2000 of them are drawn (seeded) and the largest gains
/// kept. Beyond their 98 % point p = 1 - (1 - p1)^trials, trials fitted there. Tones: the bins of their range, times sqrt(pi gain
/// / 6) as the frequency is no bin: the rate at which a chi-squared process passes that level (R. J. Adler, The Geometry of
/// Random Fields, 1981, section 4.1).
///
/// `gain` is what was found: where that is beyond all doubt, or a floor is unknown (so that the gain is of a noise model, and no
/// chi-squared to the digit), trials are counted and not simulated: as many as a fine grid has points, an upper bound. `looks`
/// take the place of simulations where there are any.
Null null_distribution(const FitProblem& problem, const Fit& from, const std::vector<Eigen::VectorXd>& starts, double gain,
                       const Looks* looks = nullptr);

}  // namespace bodeflow::residual
