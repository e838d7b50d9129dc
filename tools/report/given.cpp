#include <algorithm>

#include "graph/expand.hpp"
#include "graph/node.hpp"
#include "graph/parse.hpp"
#include "report/run_data.hpp"

namespace bodeflow::tools::report {
namespace {

std::string text_of(const graph::Node& node) { return node.is_scalar() ? node.text : graph::flow_text(node); }

GivenBlock block_of(const graph::Entry& entry) {
  GivenBlock block{entry.key, "", {}};
  for (const auto& parameter : entry.value.entries) {
    if (parameter.key == "block")
      block.id = parameter.value.text;
    else
      block.parameters.emplace_back(parameter.key, text_of(parameter.value));
  }
  return block;
}

GivenPhase phase_of(const graph::Node& node) {
  GivenPhase phase;
  for (const auto& entry : node.entries) {
    if (entry.key == "name") {
      phase.name = entry.value.text;
    } else if (entry.key == "blocks") {
      for (const auto& block : entry.value.entries) phase.blocks.push_back(block_of(block));
    } else if (entry.key == "connections") {
      for (const auto& item : entry.value.items) phase.connections.push_back(text_of(item));
    } else if (entry.key == "run" && entry.value.is_map()) {
      for (const auto& setting : entry.value.entries) phase.settings.emplace_back(setting.key, text_of(setting.value));
    } else if (entry.key != "bodeflow" && entry.key != "title" && entry.key != "phases" && entry.key != "summary") {
      phase.settings.emplace_back(entry.key, text_of(entry.value));
    }
  }
  return phase;
}

}  // namespace

tl::expected<std::vector<GivenPhase>, std::string> read_given(const std::string& graph_text) {
  graph::Report report;
  const graph::Source source{"graph.yaml", "", false};
  const auto root = graph::parse(graph_text, source, report);
  if (!root || !root->is_map()) return tl::unexpected(std::string("graph.yaml is no graph: what was done can't be told"));
  std::vector<GivenPhase> phases;
  const graph::Node* listed = root->find("phases");
  if (listed == nullptr || !listed->is_list() || root->find("blocks") != nullptr || !phase_of(*root).settings.empty())
    phases.push_back(phase_of(*root));
  if (listed != nullptr)
    for (const auto& item : listed->items) phases.push_back(phase_of(item));
  return phases;
}

std::vector<std::string> read_shown(const std::string& graph_text) {
  graph::Report report;
  const auto root = graph::parse(graph_text, graph::Source{"graph.yaml", "", false}, report);
  const graph::Node* summary = root && root->is_map() ? root->find("summary") : nullptr;
  const graph::Node* show = summary != nullptr && summary->is_map() ? summary->find("show") : nullptr;
  std::vector<std::string> names;
  if (show != nullptr)
    for (const auto& item : show->items) names.push_back(item.text);
  return names;
}

}  // namespace bodeflow::tools::report
