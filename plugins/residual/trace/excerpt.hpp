#pragma once

#include <optional>

#include "trace/candidate.hpp"

namespace bodeflow::residual {

/// Parts of the fitted records for quick searches, and a model on them as it was fitted to the whole ones.
struct Excerpt {
  Bench bench;  ///< the selecting record is whole
  Examined before;
};

/// Nothing where no fitted record has such a part, or the model can't be computed on them.
std::optional<Excerpt> excerpt_of(const Bench& bench, const Examined& before);

}  // namespace bodeflow::residual
