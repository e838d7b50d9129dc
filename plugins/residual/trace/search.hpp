#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trace/binding.hpp"
#include "trace/candidate.hpp"

namespace bodeflow::residual {

/// One round of candidates beside the effects found before it.
struct Step {
  Levels levels;
  std::vector<Candidate> candidates;  ///< best first
  std::optional<std::size_t> taken;
};

/// An effect of the final model.
struct Found {
  Addition addition;
  double share = 0.0;                    ///< of what the base model lacks: what it adds to the explanation
  std::vector<std::string> equivalents;  ///< labels or names of what can't be told from it
  std::string separation;                ///< what would tell them apart
  std::vector<Eigen::Index> amplitudes;  ///< of its parameters those at which it vanishes
};

/// What a search came to.
struct Searched {
  Examined base;
  Examined best;  ///< with all that was found
  std::vector<Step> steps;
  std::vector<Bound> refused;  ///< effects that could not be tried, with the reason
  std::vector<Found> found;
  std::vector<std::string> dropped;  ///< found first and needless in the end
  bool explains = false;             ///< what was found explains what is missing
  double share = 0.0;
  Levels levels;  ///< of all that was tried
};

struct SearchSettings {
  double alpha = 0.01;
  double share = 0.97;
  std::size_t most_effects = 3;
  std::function<void(const std::string&)> progress;  ///< told now and then what is being done; may be empty
};

/// Looks for the effects that explain what the base model leaves.
///
/// Method: forward stepwise. Every effect is tried beside those found before; the best that is accepted is added, those that it
/// makes needless are dropped again, and so on until what is left passes the class tests or `share` of the excess is explained
/// (where the floor is known), nothing more is accepted, or `most_effects` are found. The price of the search counts all
/// candidates tried so far. Then the others that explain as well are looked for at each effect's position, the other effects
/// kept.
Expected<Searched> search(const JointModel& base, const std::vector<Eigen::VectorXd>& base_starts, const Catalogue& catalogue,
                          const Bench& bench, const SearchSettings& settings);

}  // namespace bodeflow::residual
