#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace bodeflow::sanathanan_koerner {

/// How iterations from several starts compete.
struct RaceRule {
  int heat = 2;               ///< iterates of all, then the best go on
  std::size_t finalists = 3;  ///< so many of them
  int late = 5;               ///< iterates from which one that is far behind is given up
  double far_behind = 1.25;   ///< times the error of the best
  double same = 1e-6;         ///< relative difference of errors from which on two have arrived at one place
  double exact = 1e-13;       ///< error that is rounding: the others are given up
};

/// The iteration with the least error of those that start differently; null where none has an iterate. The problem has several
/// local minima, and the first iterates don't tell which start leads to the lowest, so that the best few go on to their end.
///
/// Runner: advance() makes one more iterate, false at the end; course() is its Course.
template <class Runner>
Runner* race(std::vector<Runner>& runners, const RaceRule& rule = {}) {
  const auto error = [](const Runner* r) { return r->course().best < 0 ? INFINITY : r->course().least(); };
  std::vector<Runner*> running;
  for (Runner& r : runners) running.push_back(&r);
  Runner* leader = nullptr;
  for (int iterate = 1; !running.empty(); ++iterate) {
    std::erase_if(running, [](Runner* r) { return !r->advance(); });
    for (Runner& r : runners)
      if (r.course().best >= 0 && (leader == nullptr || error(&r) < error(leader))) leader = &r;
    if (leader == nullptr || iterate < rule.heat) continue;
    std::stable_sort(running.begin(), running.end(), [&](const Runner* a, const Runner* b) { return error(a) < error(b); });
    if (iterate == rule.heat && running.size() > rule.finalists) running.resize(rule.finalists);
    std::erase_if(running, [&](const Runner* r) {
      if (r == leader) return false;
      return error(leader) < rule.exact || error(r) < (1.0 + rule.same) * error(leader) ||
             (iterate >= rule.late && error(r) > rule.far_behind * error(leader));
    });
  }
  return leader;
}

}  // namespace bodeflow::sanathanan_koerner
