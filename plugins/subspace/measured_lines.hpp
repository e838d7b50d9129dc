#pragma once

#include "lines.hpp"
#include "sanathanan_koerner/measured.hpp"

namespace bodeflow::subspace {

using sanathanan_koerner::Measured;
using sanathanan_koerner::Weighting;

/// The lines of a measured response, with one weight a line: 1; 1 / |G|; or one over the root of the mean variance of the line's
/// entries. Weighting::automatic takes the last where every line has a variance, else the first. (The weights of `measured`
/// itself are not used: the subspace equations allow one a line.) Errors: a variance that is absent or zero, a response that is
/// zero.
Expected<Lines> lines_of(const Measured& measured, Weighting weighting);

}  // namespace bodeflow::subspace
