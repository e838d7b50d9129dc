#include "graph/problem.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace bodeflow {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Letters to insert, delete, replace or swap with their neighbour (optimal string alignment), case ignored.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0u : 1u)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

/// Beyond this length nobody has mistyped a name, and the comparison would take long.
constexpr std::size_t kLongestName = 80;

}  // namespace

std::string to_string(const Problem& problem) {
  std::string out = problem.place.file;
  if (problem.place.line > 0) {
    out += (out.empty() ? "" : ":") + std::to_string(problem.place.line);
    if (problem.place.column > 0) out += ":" + std::to_string(problem.place.column);
  }
  return out.empty() ? problem.text : out + ": " + problem.text;
}

std::string to_string(const Problems& problems) {
  std::map<std::string, std::size_t> file_order;
  for (const auto& p : problems) file_order.try_emplace(p.place.file, file_order.size());
  std::vector<const Problem*> sorted;
  for (const auto& p : problems) sorted.push_back(&p);
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Problem* a, const Problem* b) {
    return std::tuple(file_order[a->place.file], a->place.line, a->place.column) <
           std::tuple(file_order[b->place.file], b->place.line, b->place.column);
  });
  std::string out;
  std::set<std::string> seen;
  for (const Problem* p : sorted) {
    std::string line = to_string(*p);
    if (seen.insert(line).second) out += line + "\n";
  }
  if (!out.empty()) out.pop_back();
  return out;
}

std::string did_you_mean(const std::string& found, const std::vector<std::string>& candidates) {
  if (found.empty() || found.size() > kLongestName) return "";
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, found.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    if (candidate.size() > kLongestName) continue;
    std::size_t d = distance(found, candidate);
    const auto dot = candidate.rfind('.');
    if (dot != std::string::npos && found.find('.') == std::string::npos)  // `sine` for `generators.sine`
      d = std::min(d, distance(found, candidate.substr(dot + 1)) + 1);
    if (d < least && d < found.size()) {
      least = d;
      nearest = &candidate;
    }
  }
  return nearest == nullptr ? "" : " (did you mean '" + *nearest + "'?)";
}

}  // namespace bodeflow
