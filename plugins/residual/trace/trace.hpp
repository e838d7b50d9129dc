#pragma once

#include <memory>
#include <string>
#include <vector>

#include "trace/search.hpp"

namespace bodeflow::residual {

enum class Verdict { none, named, not_separable, unexplained };
const char* word(Verdict verdict);

/// The records of a trace and what each is for.
struct TraceData {
  Measurements fit;                           ///< fitted together: different levels, different phases
  std::shared_ptr<const Measurement> select;  ///< ranks the candidates, never fitted
  std::shared_ptr<const Measurement> test;    ///< used once, for the errors that are reported
};

struct TraceSettings : SearchSettings {
  /// All effects there are, tried or not: declared equivalents are told where the base has a place for them.
  std::vector<EffectDescription> known;
};

/// What a base model lacks.
struct Trace {
  Verdict verdict = Verdict::none;
  bool floor_known = true;
  Searched searched;
  HeldOut test_before, test_after;  ///< on the test record
  HeldOutError before, after;       ///< the same where nothing was added
  /// Of the test record, told and not judged: by the base model, and by the model that is told.
  std::vector<ClassTest> classes_before, classes_after;
  /// The probability of a smaller p of any test or candidate where nothing is missing.
  double p = 1.0;

  bool added() const { return verdict == Verdict::named || verdict == Verdict::not_separable; }
  /// The model that is told: with what was found where it is named, else the base.
  const Examined& extended() const { return added() ? searched.best : searched.base; }
};

/// Compares the base model with the data, tries every effect of the catalogue, and names what is missing, if it can.
///
/// Method: search, then the verdict. `none`: no effect is accepted and every class passes. `named`: what was found explains what
/// is missing (where the noise floor is unknown: something was accepted; nobody can say whether it is all). `not_separable`: so
/// do others. `unexplained`: something is left, or the error on the test record is below what noise can leave (a leak) or
/// does not fall. All
/// levels follow from `alpha`. Bias: an effect that is not in the catalogue but acts like one of them within the noise takes its
/// name. Errors: those of the base model's start and fit; records that do not belong together. Throws Failure as the base model's
/// `starts` does.
Expected<Trace> trace(std::shared_ptr<const BaseModel> base, const Catalogue& catalogue, const TraceData& data,
                      const TraceSettings& settings);

}  // namespace bodeflow::residual
