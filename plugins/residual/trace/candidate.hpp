#pragma once

#include <memory>
#include <string>
#include <vector>

#include "trace/held_out.hpp"
#include "trace/levels.hpp"
#include "trace/null_distribution.hpp"

namespace bodeflow::residual {

/// The class tests of one record.
struct RecordTests {
  std::string record;
  std::vector<ClassTest> classes;
};

/// A fitted model on the records: those it was fitted to, then the one that selects.
struct Examined {
  Fit fit;
  HeldOut select;
  std::vector<RecordTests> tests;  ///< empty until `test_classes` was called

  double smallest_p() const;
  std::size_t test_count() const;
};

/// The records that are fitted and the one that selects.
struct Bench {
  Measurements fit;
  std::shared_ptr<const Measurement> select;
};

/// Errors: the model can't be computed on the selecting record.
Expected<Examined> examine(Fit fit, const Bench& bench);
/// Fills in the class tests.
void test_classes(const Bench& bench, Examined& x);

/// An effect that was tried beside the effects found before, and what came of it.
struct Candidate {
  Addition addition;
  std::string label;
  bool tried = false;       ///< it could be fitted
  bool on_parts = false;    ///< fitted to parts of the records only, see carry_over
  bool approached = false;  ///< the search ended where nothing more was promised
  Examined with;            ///< the model with it
  Null null;
  double fit_gain = 0.0;  ///< fall of minus twice the log likelihood on the fitted records
  double p = 1.0;         ///< of that gain without the effect; above 1/2 where its sign is the wrong one
  Gain select_gain;       ///< on the selecting record
  double select_p = 1.0;
  double price = 0.0;        ///< parameters, own ones of the selecting record included
  double share = 0.0;        ///< of what the base model alone lacks there: what is explained with it, all effects together
  double added_share = 0.0;  ///< what it adds to that
  bool accepted = false;     ///< it passes on the fitted records, on the selecting one, and the bounds of its parameters
  bool explains = false;     ///< and what is left passes the class tests, or `share` is reached
  std::string reason;        ///< why, or why not

  /// Gain on the selecting record less the price of the parameters.
  double merit() const { return select_gain.likelihood - 2.0 * price; }
  Eigen::VectorXd values(std::size_t record = 0) const;  ///< of the effect alone
  Eigen::VectorXd std(std::size_t record = 0) const;
};

/// What candidates are tried against.
struct Against {
  const Bench& bench;
  const Examined& before;                  ///< with the effects found so far
  const Eigen::VectorXd& original_select;  ///< residual of the base model alone on the selecting record
  const std::vector<Eigen::VectorXd>& base_starts;
  bool near_noise = false;  ///< what is left passes the class tests: small effects act linearly
  double missing = 0.0;     ///< of chi2 of the fitted records, with the base model alone: what is not noise
};

/// The candidate after a quick search from its starts, numbers filled in and not judged. Near the noise one that chance makes as
/// good more than once in twenty times is not searched: its gain is that of the linear look.
Candidate try_effect(const Addition& addition, const Against& against);
/// Takes a candidate that was tried on parts of the fitted records to the whole ones, with a few more steps; leaves others.
void carry_over(const Against& against, Candidate& c);
/// Goes on with a promising one.
void go_on(const Against& against, Candidate& c);
/// Goes on to the optimum.
void settle(const Against& against, Candidate& c);
/// Why the fitted records hardly support it, "" if they do (see hardly_supported).
std::string weakness(const Levels& levels, const Candidate& c);
/// Sets accepted and reason. `share_counts`: it has to add a part of what is missing that is worth the name.
void judge(const Levels& levels, bool share_counts, bool floor_known, Candidate& c);
/// Tests the classes and sets explains.
void judge_rest(const Levels& levels, const Bench& bench, Candidate& c);

/// How many standard deviations the better model stands above the other: the sum over all rows of the difference of the squares,
/// less the difference of the prices, over sqrt(rows) times the standard deviation of a row's; by blocks of the selecting record
/// where the floor is unknown. Reference: Q. H. Vuong, Likelihood ratio tests for model selection and non-nested hypotheses,
/// Econometrica 57 (1989) 307, equation 6.4.
double distinction(const Bench& bench, const Candidate& better, const Candidate& other);

}  // namespace bodeflow::residual
