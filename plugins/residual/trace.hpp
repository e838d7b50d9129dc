#pragma once

#include <optional>
#include <string>
#include <vector>

#include "candidate.hpp"
#include "catalogue.hpp"
#include "held_out_error.hpp"

namespace bodeflow::residual {

enum class Verdict { none, named, not_separable, unexplained };
const char* word(Verdict verdict);

/// The records of a trace and what each is for.
struct TraceData {
  std::vector<Experiment> fit;  ///< fitted together: different levels, different phases
  Experiment select;            ///< ranks the candidates, never fitted
  Experiment test;              ///< used once, for the errors that are reported
};

struct TraceSettings {
  double alpha = 0.01;  ///< probability that something is found where nothing is missing, over all classes and candidates
  double share = 0.97;  ///< part of what is missing that a named cause explains
};

/// What a base model lacks. Refers to the base model and to the effects of the catalogue, which have to outlive it.
struct Trace {
  Verdict verdict = Verdict::none;
  Levels levels;
  Scales scales;
  Examined base;
  std::vector<Candidate> candidates;                 ///< best first
  std::optional<std::size_t> found;                  ///< the candidate that was added
  std::vector<std::string> equivalents;              ///< what can't be told apart from it
  std::string separation;                            ///< what would tell them apart
  HeldOutError before, after;                        ///< on the test record; the same where nothing was added
  Eigen::VectorXcd residual_before, residual_after;  ///< lines of the test record

  const Examined& extended() const { return found ? candidates[*found].with : base; }
};

/// Compares the base model with the data, tries every effect of the catalogue, and names the one that is missing, if it can.
///
/// Method: 1. Maximum-likelihood fit of the base to the fit records; class tests there and on the selecting record. 2. Every
/// effect is fitted jointly with the base parameters and judged on the selecting record (try_effect). 3. The best by gain less
/// twice its parameters is the cause if it explains; other candidates that explain too and can't be told from it on that record
/// (distinction below the normal deviate of the same probability), and those which no experiment of this kind separates, are its
/// equivalents. 4. `none` where no effect is accepted and every class passes, `unexplained` where something is left, or where the
/// error on the test record is below what noise can leave (a leak). All levels follow from `alpha`. Bias: an effect that is not
/// in the catalogue but acts like one of them within the noise takes its name. Errors: those of the base model's start and fit;
/// records that do not belong together.
Expected<Trace> trace(const BaseModel& base, const Catalogue& catalogue, const TraceData& data, const TraceSettings& settings);

}  // namespace bodeflow::residual
