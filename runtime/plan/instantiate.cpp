#include "plan/facts.hpp"

namespace bodeflow::plan {

tl::expected<std::vector<std::unique_ptr<Instance>>, Problems> instantiate(const graph::Phase& phase, Registry& registry,
                                                                           std::shared_ptr<const HostServices> services) {
  std::vector<std::unique_ptr<Instance>> instances;
  Problems problems;
  for (const graph::Block& block : phase.blocks) {
    auto made = Instance::make(registry, block.type->id, block.name, services);
    if (!made) {
      problems.push_back({block.place, "block '" + block.name + "': " + made.error()});
      continue;
    }
    if (const auto configured = (*made)->configure(block.parameters); !configured) {
      problems.push_back({block.place, "block '" + block.name + "': " + configured.error()});
    }
    instances.push_back(std::move(*made));
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return instances;
}

tl::expected<Facts, Problems> establish_facts(const graph::Phase& phase,
                                              const std::vector<std::unique_ptr<Instance>>& instances) {
  return establish_facts(phase,
                         [&](int block, const std::vector<StreamFacts>& inputs) { return instances[block]->resolve(inputs); });
}

}  // namespace bodeflow::plan
