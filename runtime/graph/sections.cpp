#include "graph/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "graph/blocks.hpp"
#include "graph/keys.hpp"
#include "graph/scalar.hpp"
#include "graph/value.hpp"

namespace bodeflow::graph {
namespace {

void read_changes(Node& set, double time_s, int index, const BlockIndex& blocks, Phase& phase, Report& report) {
  const BlockDescription* type = blocks.type(index);
  if (type == nullptr) return;
  const std::string owner = fmt::format("schedule: block '{}'", blocks.name(index));
  const std::string unit = own_unit(phase.blocks[static_cast<std::size_t>(index)]);
  for (const auto& written : written_parameters(set, *type, owner, "", report)) {
    const ParameterDescription& described = type->parameters[static_cast<std::size_t>(written.index)];
    const std::string where = fmt::format("{}: parameter '{}'", owner, described.name);
    if (!described.live) {
      Names live;
      for (const auto& p : type->parameters)
        if (p.live) live.push_back(p.name);
      report.add(written.node->spot,
                 fmt::format("{} can't change while the graph runs; live parameters: {}", where, listed(live)));
      continue;
    }
    if (auto value = read_parameter(*written.node, described, where, report, unit))
      phase.schedule.push_back({time_s, index, written.index, std::move(*value), written.node->spot.place()});
  }
}

void read_change(Node& item, const BlockIndex& blocks, Phase& phase, Report& report) {
  if (!require_map(item, "schedule", "a map such as {at: 0.5 s, block: gain, set: {gain: 2}}", report)) return;
  check_keys(item, "schedule: ", {"at", "block", "set"}, report);
  for (const char* key : {"at", "block", "set"})
    if (item.find(key) == nullptr) report.add(item.spot, fmt::format("schedule: key '{}' is missing", key));
  double time_s = 0.0;
  if (const Node* at = item.find("at")) {
    time_s = read_number(*at, "schedule: at", "s", report).value_or(0.0);
    if (time_s < 0.0) report.add(at->spot, fmt::format("schedule: at: found {}, allowed: 0 s or later", quote(at->text)));
  }
  const Node* block = item.find("block");
  Node* set = item.find("set");
  if (block == nullptr || set == nullptr) return;
  const auto name = read_text(*block, "schedule: block", report);
  const bool is_map = require_map(*set, "schedule: set", "a map such as {gain: 2}", report);
  if (!name) return;
  const int index = blocks.find(*name, block->spot, report);
  if (index >= 0 && is_map) read_changes(*set, time_s, index, blocks, phase, report);
}

void keep(int block, const std::vector<const PortDescription*>& ports, Phase& phase) {
  for (const auto* port : ports) {
    const End end{block, port->index};
    const bool is_new =
        std::none_of(phase.recorded.begin(), phase.recorded.end(), [&](const RecordedPort& r) { return r.port == end; });
    if (port->kind == BF_STREAM && is_new) phase.recorded.push_back({end, BF_STREAM});
  }
}

/// The names under which results stand: a block's first output for records by the block's name, others with their own behind.
Names result_names(const std::vector<Phase>& phases) {
  Names names;
  for (const auto& phase : phases)
    for (const auto& block : phase.blocks) {
      if (block.type == nullptr) continue;
      std::string name = phase.name.empty() ? block.name : phase.name + "." + block.name;
      bool first = true;
      for (const auto* port : ports_of(*block.type, BF_OUT, BF_MESSAGE)) {
        names.push_back(first ? name : name + "." + port->name);
        first = false;
      }
    }
  return names;
}

}  // namespace

void read_schedule(Node& node, const BlockIndex& blocks, Phase& phase, Report& report) {
  if (node.is_none() ||
      !require_list(node, "schedule", "a list of changes such as {at: 0.5 s, block: gain, set: {gain: 2}}", report))
    return;
  for (auto& item : node.items) read_change(item, blocks, phase, report);
  std::stable_sort(phase.schedule.begin(), phase.schedule.end(),
                   [](const ScheduledChange& a, const ScheduledChange& b) { return a.time_s < b.time_s; });
}

void read_record(const Node& node, const BlockIndex& blocks, Phase& phase, Report& report) {
  if (node.is_none()) return;
  if (node.is_scalar() && node.text == "all") {
    for (std::size_t b = 0; b < phase.blocks.size(); ++b)
      if (phase.blocks[b].type != nullptr) keep(static_cast<int>(b), ports_of(*phase.blocks[b].type, BF_OUT, BF_STREAM), phase);
    return;
  }
  if (!require_list(node, "record", "all, or a list of blocks and block.port", report)) return;
  for (const auto& item : node.items) {
    if (!read_text(item, "record", report)) continue;
    const auto end = read_end(word(item, 0, item.text.size()), report);
    if (!end) continue;
    if (end->is_reference) {
      report.add(end->spot, fmt::format("record: found {}, allowed: block or block.port of this phase", quote(item.text)));
      continue;
    }
    const int block = blocks.find(end->block, end->spot, report);
    const BlockDescription* type = block < 0 ? nullptr : blocks.type(block);
    if (type == nullptr) continue;
    if (!end->port.empty()) {
      if (const auto* port = find_port(*type, end->block, BF_OUT, end->port, end->spot, report)) keep(block, {port}, phase);
    } else if (const auto outputs = ports_of(*type, BF_OUT); outputs.empty()) {
      report.add(end->spot, fmt::format("record: block '{}' ({}) has no outputs", end->block, type->id));
    } else {
      keep(block, outputs, phase);
    }
  }
}

void read_hosts(const Node& node, std::vector<Phase>& phases, Report& report) {
  if (node.is_none() || !require_map(node, "hosts", "a map of hosts and lists of blocks", report)) return;
  Names names;
  for (const auto& phase : phases)
    for (const auto& block : phase.blocks) names.push_back(block.name);
  std::map<std::string, std::string> host_of;
  for (const auto& e : node.entries) {
    const std::string where = fmt::format("hosts: {}", quote(e.key));
    if (!is_name(e.key)) report.add(e.spot, fmt::format("{} is not a name: letters, digits, _ and -", where));
    if (!require_list(e.value, where, "a list of blocks", report)) continue;
    for (const auto& item : e.value.items) {
      const auto name = read_text(item, where, report);
      if (!name) continue;
      bool found = false;
      for (auto& phase : phases)
        if (const int index = phase.block_index(*name); index >= 0) {
          phase.blocks[static_cast<std::size_t>(index)].host = e.key;
          found = true;
        }
      if (!found) {
        report.add(item.spot, fmt::format("{}: unknown block {}{}", where, quote(*name), did_you_mean(*name, names)));
      } else if (const auto [first, is_new] = host_of.try_emplace(*name, e.key); !is_new) {
        report.add(item.spot, fmt::format("{}: block '{}' is on host '{}' already", where, *name, first->second));
      }
    }
  }
}

Summary read_summary(const Node& node, const std::vector<Phase>& phases, Report& report) {
  Summary summary;
  if (node.is_none() || !require_map(node, "summary", "a map such as {show: [response], next: text}", report)) return summary;
  check_keys(node, "summary: ", {"show", "next"}, report);
  if (const Node* next = node.find("next")) summary.next = read_text(*next, "summary: next", report).value_or("");
  const Node* show = node.find("show");
  if (show == nullptr || !require_list(*show, "summary: show", "a list of results such as [response, dft.levels]", report))
    return summary;
  const Names names = result_names(phases);
  for (const auto& item : show->items) {
    const auto name = read_text(item, "summary: show", report);
    if (!name) continue;
    if (std::find(names.begin(), names.end(), *name) == names.end())
      report.add(item.spot, fmt::format("summary: show: no block gives a result {}{}; results: {}", quote(*name),
                                        did_you_mean(*name, names), listed(names)));
    summary.show.push_back(*name);
  }
  return summary;
}

}  // namespace bodeflow::graph
