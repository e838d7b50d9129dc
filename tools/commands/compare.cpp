#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "commands/data_source.hpp"
#include "commands/one_off.hpp"
#include "commands/response_change.hpp"

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

struct CompareCommand {
  std::vector<std::string> models;  ///< run directories or result.json files
  std::string key;                  ///< of the model in their results
  DataOptions data;
  std::string steps;
  ResponseChangeOptions change;  ///< where the first two are frequency responses
  std::vector<std::string> sets;
  std::string out;
  bool json = false;
};

/// The folder's name where all differ, else the paths as they were given.
std::vector<std::string> names_of(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const auto& given : paths) {
    fs::path path = fs::absolute(given).lexically_normal();
    if (!path.has_filename() || path.filename() == "result.json") path = path.parent_path();
    names.push_back(path.filename().string());
  }
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? names : paths;
}

std::string graph_of(const CompareCommand& command) {
  const auto names = names_of(command.models);
  const bool with_data = !command.data.file.empty();
  std::string title = fmt::format("Compare {}", fmt::join(names, ", "));
  if (with_data) title += " with " + fs::path(command.data.file).filename().string();
  std::string blocks, connections;
  for (std::size_t i = 0; i < command.models.size(); ++i) {
    const std::string name = fmt::format("model_{}", i + 1);
    const std::string key = command.key.empty() ? "" : ", name: " + yaml_text(command.key);
    blocks += fmt::format("  {}: {{block: acquisition.result, type: model, file: {}{}}}\n", name,
                          yaml_text(fs::absolute(command.models[i]).lexically_normal().string()), key);
    connections += fmt::format("  - {} -> compare.model\n", name);
  }
  if (with_data) {
    blocks += fmt::format("  data: {}\n", data_block(command.data, DataKind::time_series));
    connections += "  - data.input -> compare.input\n  - data.output -> compare.output\n";
  }
  const std::string steps = command.steps.empty() ? "" : ", steps: " + yaml_text(command.steps);
  blocks += fmt::format("  compare: {{block: validation.comparison, names: {}{}}}\n", yaml_text(names), steps);
  return fmt::format(
      "bodeflow: 1\ntitle: {}\nsummary: {{show: [compare]}}\nrun: {{clock: simulated}}\nblocks:\n{}connections:\n{}",
      yaml_text(title), blocks, connections);
}

int refuse(const std::string& text, int code) {
  say_error(text);
  return code;
}

/// Whether the paths are frequency responses, all of them. Refusal: some are, others are not.
tl::expected<bool, std::string> are_responses(const CompareCommand& command, Registry& registry) {
  std::vector<std::string> responses, others;
  for (const auto& path : command.models) {
    const auto response = is_response(path, command.change.name, registry);
    if (!response) return tl::unexpected(response.error());
    (*response ? responses : others).push_back(path);
  }
  if (!responses.empty() && !others.empty())
    return tl::unexpected(
        fmt::format("{} is a frequency response, {} is not: compare models with models, responses with responses",
                    responses.front(), others.front()));
  return others.empty();
}

int run_comparison(const Session& session, Registry& registry, const CompareCommand& command, const std::string& graph) {
  OneOff run{"compare", graph, {}, command.out, command.json};
  for (const auto& set : command.sets) {
    const auto equal = set.find('=');
    if (equal == std::string::npos || equal == 0)
      return refuse(fmt::format("--set '{}': expected PARAM=VALUE, such as lags=50", set), kUsage);
    run.overrides.emplace_back("blocks.compare." + set.substr(0, equal), set.substr(equal + 1));
  }
  return run_one_off(session, registry, run).exit_code;
}

/// What two frequency responses say of a change.
int compare_responses(const Session& session, Registry& registry, const CompareCommand& command) {
  if (!command.data.file.empty() || !command.key.empty())
    return refuse(std::string(command.key.empty() ? "--data" : "--model") + " belongs to models; these are frequency responses",
                  kUsage);
  if (command.models.size() != 2)
    return refuse(
        fmt::format("{} frequency responses; needed: two, before and after; repeat tests go to --repeat", command.models.size()),
        kUsage);
  for (const auto& repeat : command.change.repeats) {
    const auto response = is_response(repeat, command.change.name, registry);
    if (!response) return refuse(response.error(), kRejected);
    if (!*response) return refuse(repeat + ": no frequency response", kRejected);
  }
  return run_comparison(session, registry, command, response_change_graph(command.models[0], command.models[1], command.change));
}

int compare(const Session& session, const CompareCommand& command) {
  const DataOptions& d = command.data;
  if (d.file.empty() && (!d.inputs.empty() || !d.outputs.empty() || !d.rate.empty() || !command.steps.empty()))
    return refuse("--input, --output, --rate and --steps belong to --data", kUsage);
  for (const auto* paths : {&command.models, &command.change.repeats})
    for (const auto& path : *paths) {
      std::error_code error;
      if (!fs::exists(path, error)) return refuse(path + ": no such file, run directory or result.json", kRejected);
    }
  Registry registry = session.open_registry();
  const auto responses = are_responses(command, registry);
  if (!responses) return refuse(responses.error(), kRejected);
  if (*responses) return compare_responses(session, registry, command);
  if (!command.change.repeats.empty() || !command.change.scatter.empty() || !command.change.name.empty())
    return refuse("--repeat, --scatter and --response belong to frequency responses", kUsage);
  if (d.file.empty() && command.models.size() == 1)
    return refuse("one model alone: give another one to compare it with, or measured data with --data", kUsage);
  if (!d.file.empty()) {
    const auto kind = data_kind(d, registry);
    if (!kind) return refuse(kind.error(), kRejected);
    if (*kind == DataKind::frequency_response)
      return refuse(d.file + " holds a frequency response; --data takes samples of input and output over time", kRejected);
  }
  return run_comparison(session, registry, command, graph_of(command));
}

}  // namespace

void add_compare(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand(
      "compare", "Compare models with each other and with measured data, or two frequency responses: what has changed");
  auto options = std::make_shared<CompareCommand>();
  command
      ->add_option("models", options->models,
                   "Run directories or their result.json; or two frequency responses, before and after: files or runs")
      ->required()
      ->type_name("RUN...");
  command->add_option("--model", options->key, "Name of the model in their results (identify otherwise, or the only one)")
      ->type_name("NAME");
  command->add_option("--data", options->data.file, "Measured samples over time, in a file")->type_name("FILE");
  add_columns_to(*command, options->data);
  command->add_option("--rate", options->data.rate, "Samples per second, where the file does not say them")->type_name("HZ");
  command->add_option("--steps", options->steps, "Samples ahead of the prediction (10 otherwise)")->type_name("K");
  command->add_option("--repeat", options->change.repeats, "The first response measured again with nothing changed")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->add_option("--scatter", options->change.scatter, "By how much repeat tests of a response differ, such as '0.5 %'")
      ->type_name("SHARE");
  command->add_option("--response", options->change.name, "Name of the response in the runs' results (the only one otherwise)")
      ->type_name("NAME");
  command->add_option("--set", options->sets, "PARAM=VALUE: a parameter of validation.comparison, or validation.change")
      ->type_name("PARAM=VALUE")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Run directory (runs/<time>-compare otherwise)")->type_name("DIR");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([&session, options] { session.action = [&session, options] { return compare(session, *options); }; });
}

}  // namespace bodeflow::tools
