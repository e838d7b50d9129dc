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

/// An effect that a bench hides.
struct HiddenTruth {
  std::string name;
  double size = 0.0;
  std::string unit;
};

/// Whether the answer is right about a bench that hides these effects: none for nothing; all effects named and no other, each by
/// its own name or by one that was declared not separable from it; unexplained where one of them, and its declared equivalent,
/// is outside of the catalogue. "effect at place" counts as the effect.
bool is_right(const Answer& answer, const std::vector<HiddenTruth>& hidden);

/// The verdict beside the truth in one sentence.
std::string comparison(const Answer& answer, const std::vector<HiddenTruth>& hidden);

/// gamma, alpha, Lm_beta, sigma of the T circuit rs, rr [ohm], ls, lr, lm [H].
Eigen::Vector4d motor_truth(double rs, double rr, double ls, double lr, double lm);

}  // namespace bodeflow::residual
