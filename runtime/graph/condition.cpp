#include "graph/condition.hpp"

#include <fmt/format.h>

#include <array>

#include "graph/ends.hpp"
#include "graph/scalar.hpp"

namespace bodeflow::graph {
namespace {

constexpr const char* kForm = "$phase.block.attribute or $phase.block.port.attribute, then ==, !=, <, <=, > or >= and a value";

std::size_t dots(std::string_view text) {
  std::size_t count = 0;
  for (const char c : text) count += c == '.' ? 1u : 0u;
  return count;
}

std::variant<bool, double, std::string> value_of(std::string_view text) {
  const bool quoted = text.size() >= 2 && text.front() == text.back() && (text.front() == '"' || text.front() == '\'');
  if (quoted) return std::string(text.substr(1, text.size() - 2));
  if (const auto boolean = boolean_of(text)) return *boolean;
  if (const auto number = number_of(text, "")) return *number;
  return std::string(text);
}

/// Cuts the text at its first comparison; false: there is none.
bool cut(std::string_view text, std::string_view& left, std::string& comparison, std::string_view& right) {
  constexpr std::array<std::string_view, 6> kComparisons = {"==", "!=", "<=", ">=", "<", ">"};
  const auto at = text.find_first_of("=!<>");
  if (at == std::string_view::npos) return false;
  for (const auto candidate : kComparisons) {
    if (text.substr(at, candidate.size()) != candidate) continue;
    left = trimmed(text.substr(0, at));
    right = trimmed(text.substr(at + candidate.size()));
    comparison = std::string(candidate);
    return true;
  }
  return false;
}

}  // namespace

std::optional<Condition> read_condition(const Node& node, const std::string& where, const std::vector<Phase>& phases,
                                        const std::string& current, Report& report) {
  const auto text = read_text(node, where, report);
  if (!text) return {};
  const auto refuse = [&]() -> std::optional<Condition> {
    report.add(node.spot, fmt::format("{}: found {}, allowed: {}", where, quote(*text), kForm));
    return {};
  };
  Condition condition;
  std::string_view left = trimmed(*text), right;
  const bool compares = cut(left, left, condition.comparison, right);
  if (!compares && left.find_first_of("=!<>") != std::string_view::npos) return refuse();
  if (compares && right.empty()) return refuse();
  const std::size_t parts = dots(left) + 1;
  if (left.empty() || left.front() != '$' || parts < 3 || parts > 4) return refuse();

  const auto last = left.rfind('.');
  condition.attribute = std::string(left.substr(last + 1));
  if (!is_name(condition.attribute)) return refuse();
  condition.place = node.spot.place();
  condition.value = compares ? value_of(right) : std::variant<bool, double, std::string>(true);
  const bool ordered = condition.comparison.find_first_of("<>") != std::string::npos;
  if (ordered && !std::holds_alternative<double>(condition.value)) {
    report.add(node.spot, fmt::format("{}: {} compares numbers, found {}", where, condition.comparison, quote(right)));
    return {};
  }
  const auto end = read_end({std::string(left.substr(0, last)), node.spot}, report);
  if (!end) return {};
  const auto output = find_message_output(*end, phases, current, report);
  if (!output) return {};
  condition.phase = end->phase;
  condition.block = end->block;
  condition.port = output->port->name;
  return condition;
}

}  // namespace bodeflow::graph
