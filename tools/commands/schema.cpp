#include "graph/schema.hpp"

#include <fmt/format.h>

#include "commands/command.hpp"
#include "console/json_output.hpp"

namespace bodeflow::tools {

void add_schema(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand(
      "schema", "Print the JSON schema of graph files, for editors: blocks and parameters of all plugins found");
  command->callback([&session] {
    session.action = [&session]() -> int {
      const Registry registry = session.open_registry();
      print_json(graph::schema(registry));
      return kDone;
    };
  });
}

}  // namespace bodeflow::tools
