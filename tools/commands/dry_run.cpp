#include "commands/dry_run.hpp"

#include <algorithm>

#include "commands/device_list.hpp"
#include "commands/plans.hpp"
#include "console/json_output.hpp"
#include "phases/run.hpp"

namespace bodeflow::tools {

int dry_run(const GraphOptions& options, const graph::Graph& graph, Registry& registry, const phases::PlanSettings& settings) {
  const auto prepared = phases::prepare_all(graph, registry, phases::Services(), settings);
  if (!prepared) return options.reject(prepared.error());
  say_warnings(*prepared);
  std::vector<DeviceList> lists;
  for (std::size_t i = 0; i < graph.phases.size(); ++i)
    lists.emplace_back(graph.phases[i], (*prepared)[i], phases::excitations_of(graph.phases[i], (*prepared)[i].facts, registry));
  if (options.json) {
    nlohmann::ordered_json all = nlohmann::json::array();
    for (std::size_t i = 0; i < graph.phases.size(); ++i) {
      const auto& [instances, facts, plan, advice] = (*prepared)[i];
      nlohmann::ordered_json entry = {{"phase", graph.phases[i].name}, {"plan", plan::to_json(graph.phases[i], facts, plan)}};
      entry.update(lists[i].json());
      all.push_back(std::move(entry));
    }
    print_json(all);
    return kDone;
  }
  print_plans(graph, *prepared, false);
  for (const DeviceList& list : lists) fmt::print("{}", list.text());
  if (std::none_of(lists.begin(), lists.end(), [](const DeviceList& list) { return list.any(); }))
    fmt::print("\nNo devices, no network: nothing outside is moved.\n");
  fmt::print("\nNothing was run.\n");
  return kDone;
}

}  // namespace bodeflow::tools
