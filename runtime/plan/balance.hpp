#pragma once

#include <cstdint>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow::plan {

/// A stream edge in the eyes of the balance equations: q[from] * produced = q[to] * consumed.
struct BalanceEdge {
  int from = 0, to = 0;
  std::int64_t produced = 1, consumed = 1;
};

struct Balance {
  std::vector<std::int64_t> repetitions;  ///< the smallest whole numbers > 0 that balance each connected part
  std::vector<int> part;                  ///< which connected part a node belongs to, counted in the order of nodes
};

struct BalanceFailure {
  int edge = -1;          ///< the first edge, in the order given, that contradicts those before or overflows
  bool overflow = false;  ///< the numbers are beyond 64 bits
};

/// Solves the balance equations of synchronous dataflow in exact integers. E. A. Lee, D. G. Messerschmitt: Static scheduling
/// of synchronous data flow programs for digital signal processing, IEEE Trans. Computers C-36 (1987),
/// DOI 10.1109/TC.1987.5009446.
tl::expected<Balance, BalanceFailure> balance(int nodes, const std::vector<BalanceEdge>& edges);

}  // namespace bodeflow::plan
