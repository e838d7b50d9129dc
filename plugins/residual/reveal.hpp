#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace bodeflow::residual {

/// What a trace says, as far as a truth is compared with it.
struct Answer {
  std::string verdict;
  std::vector<std::string> effects;
  std::vector<std::string> equivalents;
  std::vector<std::string> candidates;  ///< what was in the catalogue
};

/// Whether the answer is right about a bench that hides that effect ("none": nothing): none for nothing; an effect of the
/// catalogue named alone, or declared not separable with it among those that can't be told apart; unexplained for one outside of
/// the catalogue, or its declared equivalent.
bool is_right(const Answer& answer, const std::string& hidden);

/// The verdict beside the truth in one sentence.
std::string comparison(const Answer& answer, const std::string& hidden, double size, const std::string& unit);

/// gamma, alpha, Lm_beta, sigma of the T circuit rs, rr [ohm], ls, lr, lm [H].
Eigen::Vector4d motor_truth(double rs, double rr, double ls, double lr, double lm);

}  // namespace bodeflow::residual
