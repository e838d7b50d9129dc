#include "line_choice.hpp"

#include <algorithm>
#include <functional>
#include <string>

namespace bodeflow::generators {
namespace {

using numerics::Expected;
using numerics::refused;

Expected<void> require_within(std::int64_t line, std::int64_t period) {
  const std::int64_t highest = (period - 1) / 2;
  if (line >= 1 && line <= highest) return {};
  return refused("line " + std::to_string(line) + " does not lie between zero and half of the period of " +
                 std::to_string(period) + " samples; allowed: 1 to " + std::to_string(highest));
}

}  // namespace

Expected<LineNumbers> lines_in_range(std::int64_t first, std::int64_t last, std::int64_t step, std::int64_t period) {
  if (last < first) return refused("lines.last " + std::to_string(last) + " is below lines.first " + std::to_string(first));
  if (step < 1) return refused("lines.step is " + std::to_string(step) + ", allowed: at least 1");
  for (const std::int64_t line : {first, last}) {
    if (auto within = require_within(line, period); !within) return tl::make_unexpected(within.error());
  }
  LineNumbers lines;
  for (std::int64_t k = first; k <= last; k += std::min(step, period)) lines.push_back(k);
  return lines;
}

Expected<LineNumbers> lines_in_list(LineNumbers list, std::int64_t period) {
  if (list.empty()) return refused("lines.list is empty");
  if (std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) != list.end())
    return refused("lines.list is not ascending");
  for (const std::int64_t line : {list.front(), list.back()}) {
    if (auto within = require_within(line, period); !within) return tl::make_unexpected(within.error());
  }
  return list;
}

Expected<LineNumbers> lines_of_parity(const LineNumbers& lines, std::string_view parity) {
  if (parity == "all") return lines;
  LineNumbers kept;
  std::copy_if(lines.begin(), lines.end(), std::back_inserter(kept),
               [rest = parity == "odd" ? 1 : 0](std::int64_t k) { return k % 2 == rest; });
  if (kept.empty()) return refused("lines.parity " + std::string(parity) + " leaves no line");
  return kept;
}

Expected<LineNumbers> without_detection_lines(const LineNumbers& lines, std::int64_t group, numerics::Random random) {
  const auto even = std::find_if(lines.begin(), lines.end(), [](std::int64_t k) { return k % 2 == 0; });
  if (even != lines.end()) {
    return refused("detection lines are left out among odd lines, and line " + std::to_string(*even) +
                   " is even; lines.parity: odd takes the odd ones");
  }
  const auto size = static_cast<std::int64_t>(lines.size());
  if (group < 2 || group > size) {
    return refused("detection.group is " + std::to_string(group) + ", allowed: 2 to the number of lines, " +
                   std::to_string(size));
  }
  LineNumbers kept;
  for (std::int64_t begin = 0; begin < size; begin += group) {
    const std::int64_t end = std::min(begin + group, size);
    const auto chosen = begin + static_cast<std::int64_t>(random.uniform() * static_cast<double>(group));
    for (std::int64_t i = begin; i < end; ++i) {
      if (i != chosen || end - begin < group) kept.push_back(lines[static_cast<std::size_t>(i)]);
    }
  }
  return kept;
}

}  // namespace bodeflow::generators
