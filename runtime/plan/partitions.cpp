#include "plan/partitions.hpp"

#include <algorithm>
#include <limits>

namespace bodeflow::plan {

std::vector<int> cut(const std::vector<double>& costs, int parts, double least) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const int count = static_cast<int>(costs.size());
  if (parts < 1 || parts > std::max(count, 1)) return {};
  if (parts == 1) return {0};
  std::vector<double> sum(count + 1, 0.0);
  for (int i = 0; i < count; ++i) sum[i + 1] = sum[i] + costs[i];

  // best[p][i]: smallest largest piece when the first i entries make p + 1 pieces; from[p][i]: where the last of them begins.
  std::vector<std::vector<double>> best(parts, std::vector<double>(count + 1, kNone));
  std::vector<std::vector<int>> from(parts, std::vector<int>(count + 1, 0));
  for (int i = 1; i <= count; ++i) {
    if (sum[i] >= least) best[0][i] = sum[i];
  }
  for (int p = 1; p < parts; ++p) {
    for (int i = p + 1; i <= count; ++i) {
      for (int j = i - 1; j >= p; --j) {
        const double piece = sum[i] - sum[j];
        if (piece >= best[p][i]) break;
        if (piece < least) continue;
        const double largest = std::max(piece, best[p - 1][j]);
        if (largest >= best[p][i]) continue;
        best[p][i] = largest;
        from[p][i] = j;
      }
    }
  }
  if (best[parts - 1][count] == kNone) return {};
  std::vector<int> starts(parts, 0);
  for (int p = parts - 1, end = count; p > 0; --p) {
    starts[p] = from[p][end];
    end = starts[p];
  }
  return starts;
}

}  // namespace bodeflow::plan
