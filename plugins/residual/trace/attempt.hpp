#pragma once

#include <optional>
#include <vector>

#include "trace/candidate.hpp"

namespace bodeflow::residual {

// What chance does more often than that is not looked at more closely near the noise.
inline constexpr double kWorthASearch = 0.05;
// In units of minus twice the log likelihood: what chance alone moves by more.
inline constexpr double kLeastFallOfCost = 0.05;

/// The search for the parameters of one effect beside those found before.
class Attempt {
 public:
  /// The problem's model has the effect last; all have to live as long.
  Attempt(const Against& against, FitProblem& problem);

  const Against& against() const { return against_; }
  const FitProblem& problem() const { return problem_; }
  Null& null() { return null_; }
  const Null& null() const { return null_; }
  /// By how much the model there lowers chi2.
  double gain(const Approach& a) const { return a.started ? against_.before.fit.chi2 - a.cost : 0.0; }
  /// The looks promised no more than the model there does.
  bool kept(const Approach& a) const;

  /// Sets `null` for a gain that was found.
  void find_null(double found);
  /// The model with the effect where the linear look finds most, however little that is.
  Approach nearly_nothing() const;
  /// The best of searches from the starts of the effect, and from where the linear look finds more than these do.
  Approach search_all();

 private:
  std::vector<Eigen::VectorXd> points_at(const std::vector<Eigen::VectorXd>& own) const;
  /// The best of quick searches from the most promising points.
  Approach search(const std::vector<Eigen::VectorXd>& points);
  /// The best that the looks find from some values, simulated; one that matters and that the looks can't be trusted with is
  /// searched for by simulations too, where `thorough` from all these values.
  Approach search_by_looks(const std::vector<Eigen::VectorXd>& starts, bool thorough);

  const Against& against_;
  FitProblem& problem_;
  std::optional<Looks> looks_;
  std::vector<Eigen::VectorXd> starts_;  ///< values of the effect's parameters
  Null null_;
  double promised_ = 0.0;  ///< the most that the looks found
};

}  // namespace bodeflow::residual
