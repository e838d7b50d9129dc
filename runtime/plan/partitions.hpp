#pragma once

#include <vector>

namespace bodeflow::plan {

/// Cuts a list into `parts` contiguous pieces, each with a cost of at least `least`, such that the largest cost of a piece is
/// as small as possible (of equal cuts the one with the latest last piece): the first index of each piece, or an empty list
/// where there is no such cut. Dynamic programming.
std::vector<int> cut(const std::vector<double>& costs, int parts, double least);

}  // namespace bodeflow::plan
