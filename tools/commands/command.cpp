#include "commands/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>

#include "console/json_output.hpp"
#include "plugins/crash.hpp"

namespace bodeflow::tools {
namespace {

std::filesystem::path cache_file() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/')
    return std::filesystem::path(cache) / "bodeflow" / "plugins.json";
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::filesystem::path(home) / ".cache" / "bodeflow" / "plugins.json";
  return {};
}

}  // namespace

Registry Session::open_registry() const {
  Registry::Options options;
  for (const auto& folder : plugin_path) options.path.emplace_back(folder);
  for (auto& folder : default_plugin_path()) options.path.push_back(std::move(folder));
  options.cache = cache_file();
  options.probe_command = executable;
  tell_crashes();
  return Registry(std::move(options));
}

void GraphOptions::add_to(CLI::App& app) {
  app.add_option("graph", file, "The graph: a YAML file")->required();
  app.add_option("--set", sets, "PATH=VALUE: a variable, block.parameter, or a path in the file")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
  app.add_option("--seed", seed, "Seed of all random numbers, or 'random'")->type_name("N|random");
  app.add_option("--for", duration, "Duration of the run, such as '10 s'")->type_name("DURATION");
}

tl::expected<graph::Graph, int> GraphOptions::load(const Registry& registry) const {
  graph::LoadOptions options;
  for (const auto& set : sets) {
    const auto equal = set.find('=');
    if (equal == std::string::npos || equal == 0) {
      say_error("--set '" + set + "': expected PATH=VALUE, such as gain.gain=2");
      return tl::unexpected(static_cast<int>(kUsage));
    }
    options.overrides.emplace_back(set.substr(0, equal), set.substr(equal + 1));
  }
  options.duration = duration;
  if (seed == "random") {
    options.seed = std::random_device{}();
  } else if (!seed.empty()) {
    std::size_t used = 0;
    try {
      if (seed.find_first_not_of("0123456789") != std::string::npos) throw std::invalid_argument(seed);
      options.seed = std::stoull(seed, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used != seed.size()) {
      say_error("--seed '" + seed + "': expected a whole number from 0, or 'random'");
      return tl::unexpected(static_cast<int>(kUsage));
    }
  }
  auto graph = graph::load(file, options, registry);
  if (!graph) return tl::unexpected(reject(graph.error()));
  if (options.seed)
    for (const graph::Phase& phase : graph->phases)
      if (std::any_of(phase.sweep.begin(), phase.sweep.end(), [](const graph::SweepAxis& axis) { return axis.path == "seed"; }))
        say_warning("--seed changes nothing in phase '" + phase.name + "', which sweeps the seed itself");
  return std::move(*graph);
}

void GraphOptions::add_json_to(CLI::App& app) { app.add_flag("--json", json, "Print JSON"); }

int GraphOptions::reject(const Problems& problems) const {
  say_problems(problems);
  if (json) {
    nlohmann::ordered_json all = nlohmann::json::array();
    for (const auto& problem : problems)
      all.push_back(
          {{"file", problem.place.file}, {"line", problem.place.line}, {"column", problem.place.column}, {"text", problem.text}});
    print_json(nlohmann::ordered_json{{"graph", file}, {"problems", all}});
  }
  return kRejected;
}

}  // namespace bodeflow::tools
