#include "phases/prepare.hpp"

namespace bodeflow::phases {

tl::expected<Prepared, Problems> prepare(const graph::Phase& phase, Registry& registry,
                                         std::shared_ptr<const HostServices> services, const PlanSettings& settings) {
  auto instances = plan::instantiate(phase, registry, std::move(services));
  if (!instances) return tl::unexpected(instances.error());
  auto facts = plan::establish_facts(phase, *instances);
  if (!facts) return tl::unexpected(facts.error());

  plan::PlanOptions options;
  options.chunk = settings.chunk.value_or(phase.run.chunk);
  options.threads = settings.threads.value_or(phase.run.threads);
  options.latency_s = phase.run.latency_s;
  for (const auto& recorded : phase.recorded)
    if (recorded.kind == BF_STREAM) options.kept.push_back(recorded.port);
  auto plan = plan::make_plan(phase, *facts, options);
  if (!plan) return tl::unexpected(plan.error());
  return Prepared{std::move(*instances), std::move(*facts), std::move(*plan)};
}

}  // namespace bodeflow::phases
