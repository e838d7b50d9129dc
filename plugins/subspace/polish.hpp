#pragma once

#include <optional>

#include "model.hpp"

namespace bodeflow::subspace {

/// The model after a few Sanathanan-Koerner iterations from its poles on, or nothing where they are not better than it is.
///
/// Subspace poles are a good start, but no minimum of the fit's error; a few iterations with numerators eliminated take the
/// resonances to it. With several inputs and outputs the iteration's poles belong to all entries together: the realisation is
/// truncated in balanced coordinates to the order the model had. Unstable poles are reflected. Errors: those of the iteration.
Expected<std::optional<Model>> polished(const Lines& lines, const Plane& plane, const Model& model, int iterations);

}  // namespace bodeflow::subspace
