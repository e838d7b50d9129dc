#include "commands/one_off.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "commands/vector_level.hpp"
#include "console/json_output.hpp"
#include "console/summary.hpp"

namespace bodeflow::tools {
std::string without_block(const std::string& text, const std::string& block) {
  const std::string front = "block '" + block + "': ";
  return text.rfind(front, 0) == 0 ? text.substr(front.size()) : text;
}

std::string shell_word(const std::string& word) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("/._-+:=@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

RanGraph run_one_off(const Session& session, Registry& registry, const OneOff& command) {
  graph::LoadOptions load;
  load.overrides = command.overrides;
  const auto graph = graph::load_text(command.graph, command.name + ".yaml", load, registry);
  if (!graph) {
    for (const auto& problem : graph.error()) say_error(problem.text);
    return {kRejected, {}, {}};
  }
  RunGraph options;
  options.out = command.out;
  options.graph_name = command.name;
  options.vector_level = processor_vector_level();
  options.command = {{"threads", 0}, {"chunk", 0}};
  options.executable = session.executable;
  options.plugin_path = session.plugin_path;
  options.own_graph = true;
  const RanGraph ran = run_graph(*graph, registry, options);
  if (ran.directory.empty()) return ran;
  if (command.json) {
    nlohmann::ordered_json printed = ran.result;
    printed["directory"] = ran.directory.string();
    print_json(printed);
  } else if (ran.exit_code == kDone) {
    fmt::print("{}\n", bold(graph->title));
    print_summary(ran.result, graph->summary.show);
    fmt::print("Run directory: {}\n", ran.directory.string());
    if (const auto page = ran.directory / "report.html"; std::filesystem::exists(page)) fmt::print("Report: {}\n", page.string());
  }
  return ran;
}

}  // namespace bodeflow::tools
