#include "phases/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "graph/load.hpp"
#include "phases/limits.hpp"
#include "phases/worker_pool.hpp"

namespace bodeflow::phases {
namespace {

namespace fs = std::filesystem;

/// The values of each axis in each run: runs x axes.
std::vector<std::vector<std::string>> combinations(const std::vector<graph::SweepAxis>& axes) {
  std::vector<std::vector<std::string>> runs{{}};
  for (const auto& axis : axes) {
    std::vector<std::vector<std::string>> longer;
    for (const auto& run : runs)
      for (const auto& value : axis.values) {
        longer.push_back(run);
        longer.back().push_back(value);
      }
    runs = std::move(longer);
  }
  return runs;
}

fs::path record_file(const fs::path& folder, const std::string& block, const std::string& port) {
  return folder / fmt::format("{}.{}.record", block, port);
}

void write_record(const fs::path& file, const SharedRecord& record) {
  fs::create_directories(file.parent_path());
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(record.bytes()), static_cast<std::streamsize>(record.size()));
  stream.close();
  if (!stream) throw std::runtime_error("can't write '" + file.string() + "'");
}

SharedRecord read_record(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return {};
  const std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (bytes.empty()) return {};
  return SharedRecord::copy(bytes.data(), bytes.size());
}

template <class Visit>
void for_each_message_output(const graph::Phase& phase, Visit visit) {
  for (const auto& block : phase.blocks)
    for (const auto& port : block.type->ports)
      if (port.kind == BF_MESSAGE && port.direction == BF_OUT) visit(block.name, port.name);
}

std::vector<std::string> worker_arguments(const graph::Phase& phase, const record::RunDirectory& directory,
                                          const fs::path& folder, const std::vector<std::string>& values,
                                          const RunOptions& options) {
  std::vector<std::string> arguments{options.command.string(),
                                     "phase-worker",
                                     "--graph",
                                     (directory.path() / "graph.yaml").string(),
                                     "--phase",
                                     phase.name,
                                     "--out",
                                     folder.string(),
                                     "--references",
                                     (directory.path() / "sweep" / phase.name / "references").string(),
                                     "--vector-level",
                                     std::to_string(options.vector_level)};
  for (const auto& place : options.plugin_path) arguments.insert(arguments.end(), {"--path", place});
  for (std::size_t a = 0; a < values.size(); ++a) {
    const std::string& path = phase.sweep[a].path;
    if (path == "seed") {
      arguments.insert(arguments.end(), {"--seed", values[a]});
    } else {
      const std::string prefix = phase.name.empty() ? "" : phase.name + ".";
      arguments.insert(arguments.end(), {"--set", prefix + path + "=" + values[a]});
    }
  }
  return arguments;
}

RunResult failed(const graph::Phase& phase, std::string reason) {
  return {RunResult::Status::failed, phase.name, "", std::move(reason), {}, false};
}

/// Merges what the runs sent, and takes over their hashes and what their limits met. Returns what is lost, empty: nothing.
std::string merge_runs(const graph::Phase& phase, const fs::path& folder, const std::vector<std::vector<std::string>>& values,
                       record::RunDirectory& directory, const LimitTeller& limits) {
  std::string lost;
  for_each_message_output(phase, [&](const std::string& block, const std::string& port) {
    std::vector<SharedRecord> records;
    for (std::size_t i = 0; i < values.size(); ++i)
      records.push_back(read_record(record_file(folder / std::to_string(i) / "records", block, port)));
    const auto missing = std::find_if(records.begin(), records.end(), [](const SharedRecord& record) { return !record; });
    const bool none = std::none_of(records.begin(), records.end(), [](const SharedRecord& record) { return bool(record); });
    if (none || !lost.empty()) return;
    if (missing != records.end()) {
      lost = fmt::format("run {} of the sweep: '{}.{}' sent no record, other runs did", missing - records.begin(), block, port);
    } else if (const SharedRecord merged = merge_records(records, phase.sweep, values)) {
      directory.set_result(phase.name, block, port, merged);
    } else {
      lost = fmt::format("the records of '{}.{}' can't be merged", block, port);
    }
  });
  std::vector<nlohmann::json> limits_met;
  for (std::size_t i = 0; i < values.size() && lost.empty(); ++i) {
    std::ifstream file(folder / std::to_string(i) / "manifest.json");
    const auto manifest = nlohmann::json::parse(file, nullptr, false);
    if (!manifest.is_object()) return fmt::format("run {} of the sweep left no manifest", i);
    limits_met.push_back(manifest.value(nlohmann::json::json_pointer("/phases/0/limits"), nlohmann::json::array()));
    const auto own = manifest.value("hashes", nlohmann::json::object());
    for (const auto& [key, hash] : own.items())
      directory.add_hashes({{fmt::format("sweep/{}/{}/{}", phase.name, i, key), hash.get<std::string>()}});
  }
  limits.swept(limits_met);
  return lost;
}

}  // namespace

RunResult run_sweep(const graph::Phase& phase, const plan::Plan& plan, int repeat, record::RunDirectory& directory,
                    const HostServices& services, const RunOptions& options) {
  if (const auto known = initial_records(phase, directory); !known)
    return {RunResult::Status::rejected, phase.name, "", to_string(known.error()), known.error(), false};
  const auto values = combinations(phase.sweep);
  const fs::path folder = directory.path() / "sweep" / phase.name;
  try {
    fs::create_directories(folder);
    for (const auto& r : phase.references)
      write_record(record_file(folder / "references" / r.phase, r.block, r.port),
                   directory.last_record(r.phase, r.block, r.port));
  } catch (const std::exception& error) {
    return failed(phase, error.what());
  }

  std::vector<std::vector<std::string>> commands;
  for (std::size_t i = 0; i < values.size(); ++i)
    commands.push_back(worker_arguments(phase, directory, folder / std::to_string(i), values[i], options));
  directory.event("sweep begins", {{"phase", phase.name}, {"runs", values.size()}});
  const PoolResult pool = run_processes(commands, options.stop, [&](std::size_t done) {
    if (options.progress) options.progress(phase.name, {static_cast<double>(done), static_cast<double>(commands.size()), 0.0});
  });
  if (pool.interrupted) return {RunResult::Status::interrupted, phase.name, "", "interrupted", {}, false};
  if (pool.failed) {
    RunResult result = failed(phase, fmt::format("run {} of the sweep failed: {}", *pool.failed, pool.message));
    if (pool.exit_code == kDeviceEnded) result.status = RunResult::Status::device;
    if (pool.exit_code == kLimitEnded) result.status = RunResult::Status::limit;
    return result;
  }

  const LimitTeller limits(phase, repeat, plan, directory, services);
  if (const std::string lost = merge_runs(phase, folder, values, directory, limits); !lost.empty()) return failed(phase, lost);
  directory.event("sweep ends", {{"phase", phase.name}});
  return {};
}

RunResult run_worker(const WorkerTask& task, Registry& registry, const RunOptions& options) {
  graph::LoadOptions load;
  load.overrides = task.overrides;
  load.seed = task.seed;
  auto graph = graph::load(task.graph_file, load, registry);
  if (!graph) return {RunResult::Status::rejected, task.phase, "", to_string(graph.error()), graph.error(), false};
  std::erase_if(graph->phases, [&](const graph::Phase& phase) { return phase.name != task.phase; });
  if (graph->phases.empty()) return {RunResult::Status::failed, task.phase, "", "there is no such phase", {}, false};
  graph::Phase& phase = graph->phases.front();
  phase.sweep.clear();
  phase.when.reset();
  phase.until.reset();
  phase.repeat_max = 1;

  Services services;
  auto prepared = prepare_all(*graph, registry, services, options.plan);
  if (!prepared) return {RunResult::Status::rejected, task.phase, "", to_string(prepared.error()), prepared.error(), false};
  auto directory = record::RunDirectory::create({task.directory, phase.name, {{"seed", phase.run.seed}}}, *graph);
  if (!directory) return failed(phase, directory.error());
  services.attach(**directory);
  for (const auto& r : phase.references)
    if (auto record = read_record(record_file(task.references / r.phase, r.block, r.port)))
      (*directory)->set_result(r.phase, r.block, r.port, record);

  RunResult result = run(*graph, std::move(*prepared), registry, **directory, services, options);
  if (result.status == RunResult::Status::complete) {
    try {
      for_each_message_output(phase, [&](const std::string& block, const std::string& port) {
        if (auto record = (*directory)->last_record(phase.name, block, port))
          write_record(record_file(task.directory / "records", block, port), record);
      });
    } catch (const std::exception& error) {
      result = failed(phase, error.what());
    }
  }
  const auto closed = (*directory)->close(status_word(result.status), result.reason);
  if (result.hung) {  // the block's thread lives on and may still look at all this
    (void)directory->release();
    (void)new graph::Graph(std::move(*graph));
    (void)new Services(std::move(services));
  }
  if (!closed && result.status == RunResult::Status::complete) return failed(phase, closed.error());
  return result;
}

}  // namespace bodeflow::phases
