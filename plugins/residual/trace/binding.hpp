#pragma once

#include <string>
#include <vector>

#include "trace/measurement.hpp"

namespace bodeflow::residual {

/// An effect of the catalogue at one place, or why it can't be tried there.
struct Bound {
  Addition addition;
  std::string refusal;  ///< "" if it can
};

/// Every effect of the catalogue at every place whose kind it knows, with what the records say with that model and what it
/// leaves. Effects that the model has already at that place are left out. Refused: effects of places that the base does not have,
/// laws and maps where a record is a measured response or the base has no state space, those that refuse by themselves, and those
/// without a start.
std::vector<Bound> bind_all(const Catalogue& catalogue, const JointModel& model, const std::vector<Eigen::VectorXd>& values,
                            const Measurements& records);

/// The effect at that place of the base (Addition::kNoPlace for none), its parameters from the situation.
Addition bound(const CatalogueEntry& entry, const BaseModel& base, std::size_t place, Situation situation);

}  // namespace bodeflow::residual
