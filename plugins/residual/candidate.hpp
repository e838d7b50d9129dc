#pragma once

#include <span>
#include <string>
#include <vector>

#include "joint_fit.hpp"
#include "residual_classes.hpp"

namespace bodeflow::residual {

/// The class tests of one experiment.
struct RecordTests {
  std::string record;
  std::vector<ClassTest> classes;
};

/// A fitted model on the records: those it was fitted to, then the one that selects.
struct Examined {
  Fit fit;
  std::vector<RecordTests> tests;
  Eigen::VectorXd select_residual;  ///< whitened
  double select_chi2 = 0.0;

  double smallest_p() const;
  std::size_t test_count() const;
};
Examined examine(Fit fit, std::span<const Experiment> fitted, const Experiment& select);

/// Levels that a candidate has to pass, from the probability of a false alarm and the number of candidates.
struct Levels {
  double alpha = 0.01;       ///< of a clean case, half for the classes and half for the candidates
  double p_class = 0.0;      ///< a class with a smaller p holds something: alpha / 2 over the number of class tests
  double p_candidate = 0.0;  ///< of the likelihood ratio on the fitted records: alpha / 2 over the number of candidates
  double select_gain = 0.0;  ///< of chi2 on the selecting record
  double share = 0.97;       ///< of what is missing that a cause explains

  /// select_gain is z^2 with z the normal deviate of p_candidate: a model with needless parameters theta gains
  /// N(-m, 4 m), m = |J theta|^2, on a record it was not fitted to, whose chance to be above t is largest at m = t, where it is
  /// that of a normal deviate above sqrt(t).
  static Levels of(double alpha, double share, std::size_t class_tests, std::size_t candidates);
};

/// An effect that was tried, and what came of it.
struct Candidate {
  std::string name;
  const Effect* effect = nullptr;
  Examined with;             ///< the model with it
  double fit_gain = 0.0;     ///< fall of chi2 on the fitted records
  double p = 1.0;            ///< of that gain without the effect: chi-squared, one degree of freedom a parameter
  double select_gain = 0.0;  ///< fall of chi2 on the selecting record
  double share = 0.0;        ///< of the excess over the noise on the selecting record that it removes
  bool accepted = false;     ///< it passes p_candidate, select_gain and the bounds of its parameters
  bool explains = false;     ///< and what it leaves passes the class tests, or it removes `share`
  std::string reason;        ///< why, or why not

  /// Gain on the selecting record after the price of the parameters.
  double merit() const;
};

/// The effect tried beside the base model, judged against it; the fit sets out from the base's own fit and from its starts, which
/// a missing effect has pulled less.
Candidate try_effect(const Effect& effect, const Examined& base, const std::vector<Eigen::VectorXd>& base_starts,
                     const Scales& scales, std::span<const Experiment> fitted, const Experiment& select, const Levels& levels);

/// How many standard deviations `better` stands above `other` on the selecting record: the sum of the differences of the
/// lines' squares over sqrt(lines) times their standard deviation. Reference: Q. H. Vuong, Likelihood ratio tests for model
/// selection and non-nested hypotheses, Econometrica 57 (1989) 307.
double distinction(const Examined& better, const Examined& other);

}  // namespace bodeflow::residual
