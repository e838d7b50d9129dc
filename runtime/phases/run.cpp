#include "phases/run.hpp"

#include <fmt/format.h>

#include "phases/condition.hpp"
#include "phases/excitation.hpp"
#include "phases/limits.hpp"
#include "phases/sweep.hpp"
#include "record/pacing.hpp"

namespace bodeflow::phases {
namespace {

RunResult failure(const graph::Phase& phase, std::string reason) {
  return {RunResult::Status::failed, phase.name, "", std::move(reason), {}, false};
}

RunResult run_once(const graph::Phase& phase, Prepared prepared, record::RunDirectory& directory, const RunOptions& options,
                   const HostServices& services, int repeat) {
  auto initial = initial_records(phase, directory);
  if (!initial) return rejection(phase, initial.error());
  const auto sink = directory.begin_phase(phase, prepared.facts, plan::to_json(phase, prepared.facts, prepared.plan), repeat);
  if (!sink) return failure(phase, sink.error());

  execute::Options execution = execution_of(phase, services);
  execution.seed = seed_of(phase, repeat);
  execution.vector_level = options.vector_level;
  execution.stop = options.stop;
  execution.observer = options.watch;
  for (const PastChanges& past : options.past_changes)
    if (past.phase == phase.name && past.repeat == repeat) execution.past_changes = past.changes;
  const LimitTeller limits(phase, repeat, prepared.plan, directory, services);
  execution.violated = [&](int limit, const execute::Violation& violation) { limits.violated(limit, violation); };
  if (options.progress) execution.progress = [&](const execute::Progress& progress) { options.progress(phase.name, progress); };
  execute::Sink& watched =
      options.watch == nullptr ? **sink : options.watch->begin_phase(phase, repeat, prepared.facts, prepared.plan, **sink);
  const execute::Outcome outcome =
      execute::execute(phase, prepared.facts, prepared.plan, prepared.instances, *initial, watched, execution);
  if (options.watch != nullptr) options.watch->end_phase();
  if (const std::string kept = record::pacing_text(record::pacing_json(phase.run, outcome)); !kept.empty())
    services.log("clock", BF_LOG_INFO, kept);
  limits.ended(outcome);
  const auto ended = directory.end_phase(outcome);

  RunResult result;
  result.phase = phase.name;
  result.hung = outcome.hung;
  if (result.hung)  // the stuck block must not be destroyed under its thread
    for (auto& instance : prepared.instances) (void)instance.release();
  if (outcome.interrupted) {
    result.status = RunResult::Status::interrupted;
    result.reason = outcome.reason;
  } else if (outcome.limit >= 0) {
    result.status = RunResult::Status::limit;
    result.reason = outcome.reason;
  } else if (outcome.status != execute::Outcome::Status::complete) {
    result.status = RunResult::Status::failed;
    if (outcome.failed_block >= 0) {
      const graph::Block& block = phase.blocks[static_cast<std::size_t>(outcome.failed_block)];
      result.block = block.name;
      result.status = failure_of(block);
    }
    result.reason = outcome.reason;
  } else if (!ended) {
    return failure(phase, ended.error());
  }
  return result;
}

/// A sweep; who looks on sees its merged records.
RunResult watched_sweep(const graph::Phase& phase, const plan::Plan& plan, int repeat, record::RunDirectory& directory,
                        const HostServices& services, const RunOptions& options) {
  if (options.watch == nullptr) return run_sweep(phase, plan, repeat, directory, services, options);
  options.watch->begin_sweep(phase, repeat);
  RunResult result = run_sweep(phase, plan, repeat, directory, services, options);
  for (std::size_t b = 0; b < phase.blocks.size(); ++b)
    for (const auto& port : phase.blocks[b].type->ports) {
      if (port.kind != BF_MESSAGE || port.direction != BF_OUT) continue;
      if (const SharedRecord merged = directory.last_record(phase.name, phase.blocks[b].name, port.name))
        options.watch->add_record(phase, {static_cast<int>(b), port.index}, merged);
    }
  options.watch->end_phase();
  return result;
}

/// True unless the condition is there and does not hold.
tl::expected<bool, Problem> allowed(const std::optional<graph::Condition>& condition, const record::RunDirectory& directory) {
  if (!condition) return true;
  return holds(*condition, directory.last_record(condition->phase, condition->block, condition->port));
}

}  // namespace

execute::Options execution_of(const graph::Phase& phase, const HostServices& services) {
  execute::Options options;
  options.clock = phase.run.clock;
  options.warn = [&services](const std::string& text) { services.log("run", BF_LOG_WARNING, text); };
  options.watchdog_s = phase.run.watchdog_s;
  return options;
}

std::uint64_t seed_of(const graph::Phase& phase, int repeat) {
  std::uint64_t hash = phase.run.seed;
  if (phase.name.empty() && repeat == 0) return hash;
  for (const char c : fmt::format("{}@{}", phase.name, repeat))
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;  // FNV-1a
  return hash;
}

RunResult rejection(const graph::Phase& phase, Problems problems) {
  return {RunResult::Status::rejected, phase.name, "", to_string(problems), std::move(problems), false};
}

RunResult::Status failure_of(const graph::Block& block) {
  return is_outside(block) ? RunResult::Status::device : RunResult::Status::failed;
}

const char* status_word(RunResult::Status status) {
  switch (status) {
    case RunResult::Status::complete:
      return "complete";
    case RunResult::Status::interrupted:
      return "partial";
    case RunResult::Status::limit:
      return "limit";
    default:
      return "failed";
  }
}

tl::expected<std::vector<execute::InitialRecord>, Problems> initial_records(const graph::Phase& phase,
                                                                            const record::RunDirectory& directory) {
  std::vector<execute::InitialRecord> records;
  Problems problems;
  for (const auto& reference : phase.references) {
    SharedRecord record = directory.last_record(reference.phase, reference.block, reference.port);
    if (record)
      records.push_back({reference.to, std::move(record)});
    else
      problems.push_back({reference.place, fmt::format("'${}.{}.{}': that phase sent no such record", reference.phase,
                                                       reference.block, reference.port)});
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return records;
}

tl::expected<std::vector<Prepared>, Problems> prepare_all(const graph::Graph& graph, Registry& registry, const Services& services,
                                                          const PlanSettings& settings) {
  std::vector<Prepared> all;
  Problems problems;
  for (const auto& phase : graph.phases) {
    auto prepared = prepare(phase, registry, services.host(), settings);
    if (prepared)
      all.push_back(std::move(*prepared));
    else
      problems.insert(problems.end(), prepared.error().begin(), prepared.error().end());
  }
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return all;
}

RunResult run_in_order(const graph::Graph& graph, record::RunDirectory& directory, const RunPhase& run_phase,
                       const std::function<void(const graph::Phase&, const std::string&)>& warn) {
  for (std::size_t i = 0; i < graph.phases.size(); ++i) {
    const graph::Phase& phase = graph.phases[i];
    const auto wanted = allowed(phase.when, directory);
    if (!wanted) return rejection(phase, {wanted.error()});
    if (!*wanted) {
      directory.event("phase skipped", {{"phase", phase.name}});
      continue;
    }
    for (int repeat = 0; repeat < phase.repeat_max; ++repeat) {
      RunResult result = run_phase(i, repeat);
      if (result.status != RunResult::Status::complete) return result;
      if (!phase.until) continue;
      const auto enough = allowed(phase.until, directory);
      if (!enough) return rejection(phase, {enough.error()});
      if (*enough) break;
      if (repeat + 1 == phase.repeat_max) warn(phase, fmt::format("'until' was not met in {} repetitions", phase.repeat_max));
    }
  }
  return {};
}

RunResult run(const graph::Graph& graph, std::vector<Prepared> prepared, Registry& registry, record::RunDirectory& directory,
              const Services& services, const RunOptions& options) {
  const auto run_phase = [&](std::size_t index, int repeat) -> RunResult {
    const graph::Phase& phase = graph.phases[index];
    if (!phase.sweep.empty()) return watched_sweep(phase, prepared[index].plan, repeat, directory, *services.host(), options);
    if (repeat > 0) {
      auto again = prepare(phase, registry, services.host(), options.plan);
      if (!again) return rejection(phase, again.error());
      prepared[index] = std::move(*again);
    }
    return run_once(phase, std::move(prepared[index]), directory, options, *services.host(), repeat);
  };
  return run_in_order(graph, directory, run_phase, [&](const graph::Phase& phase, const std::string& text) {
    services.host()->log("phase " + phase.name, BF_LOG_WARNING, text);
  });
}

}  // namespace bodeflow::phases
