#pragma once

#include <cstddef>

namespace bodeflow::residual {

/// Levels that tests and candidates have to pass, all from the probability of a false alarm and the number of tries.
struct Levels {
  double alpha = 0.01;   ///< of a clean case, half for the classes and half for the candidates
  double share = 0.97;   ///< of what is missing that a named cause explains
  bool support = false;  ///< effects have to be supported by blocks of a record over time (see hardly_supported)
  std::size_t class_tests = 1;
  std::size_t candidates = 1;  ///< tried so far, over all steps

  /// A class with a smaller p holds something: alpha / 2 over the number of class tests.
  double p_class() const;
  /// Of a candidate, on the fitted records and on the selecting one: alpha / 2 over the number of candidates.
  double p_candidate() const;
  /// A normal deviate above it is no chance: that of p_candidate.
  double z_candidate() const;
  /// By blocks of a record whose noise floor is unknown: the normal deviate of alpha / 2. It guards the likelihood, which has
  /// paid for the search already.
  double z_block() const;
};

/// The part of the original excess that a second or third effect has to remove.
inline constexpr double kLeastShare = 0.05;
/// Where the floor is unknown: the part by which an effect has to lower the error on the selecting record.
inline constexpr double kLeastFall = 0.02;

/// The probability of so much gain on a record that was not fitted, from parameters that mean nothing.
///
/// A model with needless shared parameters theta gains N(-m, 4 m), m = |J theta|^2, there; its chance to be above t is largest at
/// m = t, where it is that of a normal deviate above sqrt(t): half a chi-squared of one degree of freedom. `fitted` numbers that
/// the record itself determined add a chi-squared of as many.
double held_out_p(double gain, double fitted);

}  // namespace bodeflow::residual
