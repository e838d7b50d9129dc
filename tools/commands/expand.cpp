#include <fmt/format.h>

#include "commands/command.hpp"

namespace bodeflow::tools {

void add_expand(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("expand", "Print a graph as one file: includes and variables resolved, overrides applied");
  auto options = std::make_shared<GraphOptions>();
  options->add_to(*command);
  command->callback([&session, options] {
    session.action = [&session, options]() -> int {
      const Registry registry = session.open_registry();
      const auto graph = options->load(registry);
      if (!graph) return graph.error();
      fmt::print("{}", graph->expanded);
      return kDone;
    };
  });
}

}  // namespace bodeflow::tools
