#include "commands/plans.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "console/console.hpp"
#include "console/json_output.hpp"

namespace bodeflow::tools {

void say_warnings(const std::vector<phases::Prepared>& prepared) {
  for (const auto& phase : prepared)
    for (const auto& warning : phase.facts.warnings) say_warning(warning);
  for (const auto& phase : prepared)
    for (const auto& [block, said] : phase.advice)
      if (said.level >= BF_LOG_WARNING) say_warning(block + ": " + said.text);
}

void print_plans(const graph::Graph& graph, const std::vector<phases::Prepared>& prepared, bool as_json) {
  nlohmann::ordered_json all = nlohmann::json::array();
  for (std::size_t i = 0; i < graph.phases.size(); ++i) {
    const auto& phase = graph.phases[i];
    const auto& [instances, facts, plan, advice] = prepared[i];
    if (as_json) {
      all.push_back({{"phase", phase.name}, {"plan", plan::to_json(phase, facts, plan)}});
      continue;
    }
    if (!phase.name.empty()) fmt::print("{}\n", bold("phase " + phase.name));
    fmt::print("{}", plan::to_text(phase, facts, plan));
  }
  if (as_json) print_json(all);
}

}  // namespace bodeflow::tools
