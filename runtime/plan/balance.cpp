#include "plan/balance.hpp"

#include "plan/exact.hpp"

namespace bodeflow::plan {
namespace {

struct Solver {
  int nodes;
  const std::vector<BalanceEdge>& edges;
  std::vector<std::vector<int>> incident;  ///< edges at a node
  std::vector<Rate> ratio;                 ///< firings relative to the first node of the part
  Balance result;

  Solver(int n, const std::vector<BalanceEdge>& e) : nodes(n), edges(e), incident(n), ratio(n) {
    result.repetitions.assign(n, 0);
    result.part.assign(n, -1);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      incident[edges[i].from].push_back(static_cast<int>(i));
      incident[edges[i].to].push_back(static_cast<int>(i));
    }
  }

  /// Gives a ratio to all that hangs together with `root`; the members, or the edge that failed.
  tl::expected<std::vector<int>, BalanceFailure> spread(int root, int part) {
    std::vector<int> members{root};
    ratio[root] = {1, 1};
    result.part[root] = part;
    for (std::size_t next = 0; next < members.size(); ++next) {
      const int node = members[next];
      for (const int index : incident[node]) {
        const BalanceEdge& edge = edges[index];
        const bool forward = edge.from == node;
        const int other = forward ? edge.to : edge.from;
        const Rate& mine = ratio[node];
        const auto theirs = forward ? fraction(Wide{mine.num} * edge.produced, Wide{mine.den} * edge.consumed)
                                    : fraction(Wide{mine.num} * edge.consumed, Wide{mine.den} * edge.produced);
        if (!theirs) return tl::unexpected(BalanceFailure{index, true});
        if (result.part[other] < 0) {
          result.part[other] = part;
          ratio[other] = *theirs;
          members.push_back(other);
        } else if (ratio[other] != *theirs) {
          return tl::unexpected(BalanceFailure{index, false});
        }
      }
    }
    return members;
  }

  /// The smallest whole numbers with those ratios; false: beyond 64 bits.
  bool make_whole(const std::vector<int>& members) {
    Wide denominator = 1, divisor = 0;
    for (const int node : members) {
      const std::int64_t den = ratio[node].den;
      const auto multiple = narrow(denominator / greatest_common_divisor(denominator, den) * den);
      if (!multiple) return false;
      denominator = *multiple;
    }
    for (const int node : members) {
      const Rate& r = ratio[node];
      const auto count = narrow(Wide{r.num} * (denominator / r.den));
      if (!count) return false;
      result.repetitions[node] = *count;
      divisor = greatest_common_divisor(*count, divisor);
    }
    for (const int node : members) result.repetitions[node] /= static_cast<std::int64_t>(divisor);
    return true;
  }
};

}  // namespace

tl::expected<Balance, BalanceFailure> balance(int nodes, const std::vector<BalanceEdge>& edges) {
  Solver solver(nodes, edges);
  int part = 0;
  for (int root = 0; root < nodes; ++root) {
    if (solver.result.part[root] >= 0) continue;
    const auto members = solver.spread(root, part++);
    if (!members) return tl::unexpected(members.error());
    if (!solver.make_whole(*members)) {
      const auto& edges_here = solver.incident[root];
      return tl::unexpected(BalanceFailure{edges_here.empty() ? -1 : edges_here.front(), true});
    }
  }
  return std::move(solver.result);
}

}  // namespace bodeflow::plan
