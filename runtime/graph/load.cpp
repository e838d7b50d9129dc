#include "graph/load.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "graph/check.hpp"
#include "graph/document.hpp"
#include "graph/expand.hpp"
#include "graph/overrides.hpp"
#include "graph/variables.hpp"

namespace bodeflow::graph {
namespace {

/// In file order, the files in the order in which they were read.
Problems sorted(const Report& report, const Document& document) {
  std::map<std::string, std::size_t> order;
  for (const auto& source : document.sources) order.try_emplace(source.file, order.size());
  Problems problems = report.problems();
  const auto key = [&](const Problem& p) { return std::tuple(order[p.place.file], p.place.line, p.place.column); };
  std::stable_sort(problems.begin(), problems.end(), [&](const Problem& a, const Problem& b) { return key(a) < key(b); });
  return problems;
}

}  // namespace

tl::expected<Graph, Problems> load(const std::string& file, const LoadOptions& options, const Registry& registry) {
  Report report;
  const auto text = read_file(file, {}, report);
  if (!text) return tl::unexpected(report.problems());
  return load_text(*text, file, options, registry);
}

tl::expected<Graph, Problems> load_text(const std::string& text, const std::string& file, const LoadOptions& options,
                                        const Registry& registry) {
  Document document;
  Report report;
  if (!assemble(text, file, document, report)) return tl::unexpected(sorted(report, document));

  Node& root = document.root;
  std::vector<Override> overrides = read_overrides(options.overrides, document, report);
  Variables variables(root.find("variables"), report);
  set_variables(overrides, variables, report);
  variables.check();
  root.erase("variables");
  variables.substitute(root);
  for (auto& o : overrides) variables.substitute(o.value);
  apply(overrides, variables, root, report);
  if (!options.duration.empty()) apply_run_key("duration", options.duration, document.add_source("--for", "", true), root);
  if (options.seed) apply_run_key("seed", std::to_string(*options.seed), document.add_source("--seed", "", true), root);

  Graph graph = check(root, registry, report);
  if (!report.empty()) return tl::unexpected(sorted(report, document));
  graph.file = file;
  graph.expanded = to_yaml(root);
  return graph;
}

}  // namespace bodeflow::graph
