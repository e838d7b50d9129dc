#include "graph/schema.hpp"

#include <fmt/format.h>

#include "commands/command.hpp"

namespace bodeflow::tools {

void add_schema(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand(
      "schema", "Print the JSON schema of graph files, for editors: blocks and parameters of all plugins found");
  command->callback([&session] {
    session.action = [&session]() -> int {
      const Registry registry = session.open_registry();
      fmt::print("{}\n", graph::schema(registry).dump(2));
      return kDone;
    };
  });
}

}  // namespace bodeflow::tools
