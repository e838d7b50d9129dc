#include "graph/requirements.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "graph/keys.hpp"
#include "graph/scalar.hpp"

namespace bodeflow::graph {
namespace {

std::optional<std::vector<int>> numbers_of(std::string_view version) {
  std::vector<int> numbers;
  while (true) {
    int number = 0;
    const auto [end, error] = std::from_chars(version.data(), version.data() + version.size(), number);
    if (error != std::errc() || number < 0) return {};
    numbers.push_back(number);
    version.remove_prefix(static_cast<std::size_t>(end - version.data()));
    if (version.empty() || version.front() == '-' || version.front() == '+') return numbers;  // "1.2.0-beta"
    if (version.front() != '.') return {};
    version.remove_prefix(1);
  }
}

/// Nothing: the requirement can't be read.
std::optional<bool> fulfils(std::string_view version, std::string_view requirement) {
  constexpr std::array<std::string_view, 5> kComparisons = {">=", "<=", "==", ">", "<"};
  std::string_view comparison = ">=", number = requirement;
  for (const auto candidate : kComparisons)
    if (requirement.substr(0, candidate.size()) == candidate) {
      comparison = candidate;
      number = trimmed(requirement.substr(candidate.size()));
      break;
    }
  const auto order = compare_versions(version, number);
  if (!order) return {};
  if (comparison == ">=") return *order >= 0;
  if (comparison == "<=") return *order <= 0;
  if (comparison == "==") return *order == 0;
  return comparison == ">" ? *order > 0 : *order < 0;
}

void check(const PluginDescription& plugin, const Node& node, const std::string& where, Report& report) {
  std::string_view rest = node.text;
  while (true) {
    const auto comma = rest.find(',');
    const auto met = fulfils(plugin.version, trimmed(rest.substr(0, comma)));
    if (!met) {
      report.add(node.spot,
                 fmt::format("{}: found {}, allowed: comparisons such as '>=1.2' or '>=1.2, <2'", where, quote(node.text)));
      return;
    }
    if (!*met) {
      report.add(node.spot, fmt::format("{}: found version {}, the graph needs {}", where, plugin.version, node.text));
      return;
    }
    if (comma == std::string_view::npos) return;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace

std::optional<int> compare_versions(std::string_view a, std::string_view b) {
  auto left = numbers_of(a), right = numbers_of(b);
  if (!left || !right) return {};
  const std::size_t size = std::max(left->size(), right->size());
  left->resize(size, 0);
  right->resize(size, 0);
  return *left < *right ? -1 : *left == *right ? 0 : 1;
}

void check_requirements(const Node& node, const Registry& registry, Report& report) {
  if (node.is_none() || !require_map(node, "requires", "a map such as {frisch: '>=1.2'}", report)) return;
  for (const auto& e : node.entries) {
    const std::string where = fmt::format("requires: plugin {}", quote(e.key));
    const PluginDescription* plugin = nullptr;
    Names names;
    for (const auto& candidate : registry.plugins()) {
      names.push_back(candidate.name);
      if (candidate.name == e.key && (plugin == nullptr || candidate.refused.empty())) plugin = &candidate;
    }
    if (!read_text(e.value, where, report)) continue;
    if (plugin == nullptr) {
      report.add(e.spot, fmt::format("{} is not installed{}", where, did_you_mean(e.key, names)));
    } else if (!plugin->refused.empty()) {
      report.add(e.spot, fmt::format("{} can't be used: {}", where, plugin->refused));
    } else {
      check(*plugin, e.value, where, report);
    }
  }
}

}  // namespace bodeflow::graph
