#include "phases/prepare.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace bodeflow::phases {
namespace {

std::uint64_t physical_memory() {
  return static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

/// Scheduled changes that no firing of their block is left for.
void warn_of_late_changes(const graph::Phase& phase, plan::Facts& facts) {
  for (const auto& change : phase.schedule) {
    const auto& block = facts.blocks[static_cast<std::size_t>(change.block)];
    if (block.firings < 0 || !block.firing_rate.known()) continue;
    const double last_s = static_cast<double>(block.firings - 1) / block.firing_rate.hz();
    if (change.time_s > last_s)
      facts.warnings.push_back(to_string(
          Problem{change.place, fmt::format("the change at {} s never happens: block '{}' fires for the last time at {} s",
                                            change.time_s, phase.blocks[static_cast<std::size_t>(change.block)].name, last_s)}));
  }
}

/// What the blocks have to say, in the order of the graph.
tl::expected<std::vector<Advice>, Problems> advice_of(const graph::Phase& phase,
                                                      const std::vector<std::unique_ptr<Instance>>& instances,
                                                      const plan::Facts& facts) {
  std::vector<Advice> advice;
  for (std::size_t b = 0; b < instances.size(); ++b) {
    auto said = instances[b]->advise(facts.blocks[b].inputs, facts.blocks[b].outputs);
    if (!said)
      return tl::unexpected(Problems{{phase.blocks[b].place, fmt::format("block '{}': {}", phase.blocks[b].name, said.error())}});
    for (AdviceText& text : *said) advice.push_back({phase.blocks[b].name, std::move(text)});
  }
  return advice;
}

}  // namespace

plan::PlanOptions plan_options(const graph::Phase& phase, const PlanSettings& settings) {
  plan::PlanOptions options;
  options.chunk = settings.chunk.value_or(phase.run.chunk);
  options.threads = settings.threads.value_or(phase.run.threads);
  options.latency_s = phase.run.latency_s;
  for (const auto& recorded : phase.recorded)
    if (recorded.kind == BF_STREAM) options.kept.push_back(recorded.port);
  return options;
}

tl::expected<Prepared, Problems> prepare(const graph::Phase& phase, Registry& registry,
                                         std::shared_ptr<const HostServices> services, const PlanSettings& settings) {
  auto instances = plan::instantiate(phase, registry, std::move(services));
  if (!instances) return tl::unexpected(instances.error());
  auto facts = plan::establish_facts(phase, *instances);
  if (!facts) return tl::unexpected(facts.error());

  auto plan = plan::make_plan(phase, *facts, plan_options(phase, settings));
  if (!plan) return tl::unexpected(plan.error());
  const std::uint64_t memory = physical_memory();
  if (plan->bytes > memory)
    return tl::unexpected(Problems{
        {phase.place, fmt::format("{}the buffers need {:.3g} GB, this machine has {:.3g} GB: a delay or a period is too long",
                                  phase.name.empty() ? "" : fmt::format("phase '{}': ", phase.name),
                                  static_cast<double>(plan->bytes) / 1e9, static_cast<double>(memory) / 1e9)}});
  warn_of_late_changes(phase, *facts);
  auto advice = advice_of(phase, *instances, *facts);
  if (!advice) return tl::unexpected(advice.error());
  return Prepared{std::move(*instances), std::move(*facts), std::move(*plan), std::move(*advice)};
}

}  // namespace bodeflow::phases
