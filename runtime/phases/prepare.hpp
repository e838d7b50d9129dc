#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "plan/plan.hpp"

namespace bodeflow::phases {

/// What a block says before its phase runs.
struct Advice {
  std::string block;
  AdviceText said;
};

/// A phase that is ready to run.
struct Prepared {
  std::vector<std::unique_ptr<Instance>> instances;  ///< configured and resolved
  plan::Facts facts;
  plan::Plan plan;
  std::vector<Advice> advice;  ///< in the order of the graph
};

/// What the command line says over the graph's own `run` settings.
struct PlanSettings {
  std::optional<int> threads;
  std::optional<std::int64_t> chunk;
};

/// How a phase is planned: its own words, and those of the command line over them.
plan::PlanOptions plan_options(const graph::Phase& phase, const PlanSettings& settings);

/// The prepared phase: blocks made, facts established, plan made. Errors are those of these three steps, the first that has any.
tl::expected<Prepared, Problems> prepare(const graph::Phase& phase, Registry& registry,
                                         std::shared_ptr<const HostServices> services, const PlanSettings& settings);

}  // namespace bodeflow::phases
