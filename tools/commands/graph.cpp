#include <fmt/format.h>

#include <cstdio>

#include "commands/command.hpp"
#include "console/drawing.hpp"

namespace bodeflow::tools {
namespace {

/// Gives DOT text to Graphviz. Error: why there is no picture.
tl::expected<void, std::string> print_svg(const std::string& dot) {
  if (std::system("command -v dot >/dev/null 2>&1") != 0)
    return tl::unexpected(std::string("svg needs Graphviz (apt-get install graphviz); --format dot and mermaid do without"));
  std::fflush(stdout);
  FILE* pipe = popen("dot -Tsvg", "w");
  if (pipe == nullptr) return tl::unexpected(std::string("can't start Graphviz"));
  std::fwrite(dot.data(), 1, dot.size(), pipe);
  if (pclose(pipe) != 0) return tl::unexpected(std::string("Graphviz failed"));
  return {};
}

int draw(const Session& session, const GraphOptions& options, const std::string& format) {
  const Registry registry = session.open_registry();
  const auto graph = options.load(registry);
  if (!graph) return graph.error();
  if (format == "mermaid") {
    fmt::print("{}", to_mermaid(*graph));
  } else if (format == "dot") {
    fmt::print("{}", to_dot(*graph));
  } else if (const auto drawn = print_svg(to_dot(*graph)); !drawn) {
    say_error(drawn.error());
    return kRunFailed;
  }
  return kDone;
}

}  // namespace

void add_graph(CLI::App& app, Session& session) {
  auto* command = app.add_subcommand("graph", "Draw a graph");
  auto options = std::make_shared<GraphOptions>();
  auto format = std::make_shared<std::string>("svg");
  options->add_to(*command);
  command->add_option("--format", *format, "svg (through Graphviz), dot or mermaid")
      ->check(CLI::IsMember({"svg", "dot", "mermaid"}));
  command->callback(
      [&session, options, format] { session.action = [&session, options, format] { return draw(session, *options, *format); }; });
}

}  // namespace bodeflow::tools
