#include "graph/check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "graph/blocks.hpp"
#include "graph/condition.hpp"
#include "graph/connections.hpp"
#include "graph/keys.hpp"
#include "graph/limits.hpp"
#include "graph/requirements.hpp"
#include "graph/run_settings.hpp"
#include "graph/scalar.hpp"
#include "graph/sections.hpp"
#include "graph/sweep.hpp"

namespace bodeflow::graph {
namespace {

constexpr std::int64_t kMostRepeats = 1'000'000;

/// Whether outside hardware holds the block back: it is a device, and its samples come or go at the device's own rate.
bool paces(const Block& block) {
  const bool streams = block.type->count(BF_STREAM, BF_IN) + block.type->count(BF_STREAM, BF_OUT) > 0;
  return streams && block.type->has_role("device");
}

class Checker {
 public:
  Checker(Node& root, const Registry& registry, Report& report) : root_(root), registry_(registry), report_(report) {}

  Graph graph() {
    check_keys(root_, "", graph_keys(), report_);
    check_version();
    if (const Node* node = root_.find("title"); node != nullptr && !node->is_none())
      graph_.title = read_text(*node, "title", report_).value_or("");
    if (const Node* node = root_.find("requires")) check_requirements(*node, registry_, report_);
    if (const Node* node = root_.find("run")) read_run(*node, run_, report_);
    if (Node* phases = root_.find("phases")) {
      refuse_with_phases();
      read_phases(*phases);
    } else if (root_.find("blocks") == nullptr) {
      report_.add(root_.spot, "key 'blocks' is missing: a graph has blocks (or phases)");
    } else {
      Phase& phase = graph_.phases.emplace_back();
      phase.place = root_.spot.place();
      phase.run = run_;
      read_content(root_, {}, phase);
    }
    if (const Node* node = root_.find("limits")) read_limits(*node, graph_.phases, report_);
    if (const Node* node = root_.find("hosts")) read_hosts(*node, graph_.phases, report_);
    if (const Node* node = root_.find("summary")) graph_.summary = read_summary(*node, graph_.phases, report_);
    return std::move(graph_);
  }

 private:
  void check_version() {
    const Node* node = root_.find("bodeflow");
    if (node == nullptr) {
      report_.add(root_.spot, fmt::format("key 'bodeflow' is missing: a graph file begins with 'bodeflow: {}'", kFormat));
      return;
    }
    if (node->broken) return;
    const auto version = node->is_scalar() ? integer_of(node->text) : tl::unexpected(std::string());
    if (!version || *version != kFormat)
      report_.add(node->spot, fmt::format("bodeflow: found {}, allowed: {} (the version of the format)", what(*node), kFormat));
  }

  void refuse_with_phases() {
    for (const char* key : {"blocks", "connections", "schedule", "record"})
      if (const Entry* e = root_.entry(key))
        report_.add(e->spot, fmt::format("'{}' can't stand beside 'phases': put it into a phase", key));
  }

  void read_phases(Node& phases) {
    if (!require_list(phases, "phases", "a list of phases", report_)) return;
    if (phases.items.empty()) report_.add(phases.spot, "phases: an empty list, allowed: at least one phase");
    for (auto& item : phases.items) {
      if (!require_map(item, "phase", "a map such as {name: identify, blocks: ...}", report_)) continue;
      Phase phase;
      phase.place = item.spot.place();
      phase.run = run_;
      read_phase(item, phase);
      graph_.phases.push_back(std::move(phase));
    }
  }

  void read_phase(Node& item, Phase& phase) {
    read_name(item, phase);
    const std::string where = fmt::format("phase {}: ", quote(phase.name));
    check_keys(item, where, phase_keys(), report_);
    if (const Node* node = item.find("run")) read_run(*node, phase.run, report_);
    if (item.find("blocks") == nullptr) report_.add(item.spot, where + "key 'blocks' is missing");
    read_content(item, graph_.phases, phase);
    if (const Node* node = item.find("limits")) read_limits(*node, {&phase, 1}, report_);
    if (const Node* node = item.find("when")) phase.when = read_condition(*node, "when", graph_.phases, phase.name, report_);
    if (const Node* node = item.find("repeat")) read_repeat(*node, phase);
    if (Node* node = item.find("sweep")) read_sweep(*node, phase, report_);
    if (item.find("repeat") != nullptr && item.find("sweep") != nullptr)
      report_.add(item.entry("sweep")->spot, where + "'sweep' can't stand beside 'repeat'");
  }

  void read_name(const Node& item, Phase& phase) {
    const Node* node = item.find("name");
    if (node == nullptr) {
      report_.add(item.spot, "phase: key 'name' is missing");
      return;
    }
    phase.name = read_text(*node, "phase: name", report_).value_or("");
    if (!phase.name.empty() && !is_name(phase.name))
      report_.add(node->spot, fmt::format("phase: {} is not a name: letters, digits, _ and -", quote(phase.name)));
    for (const auto& earlier : graph_.phases)
      if (!phase.name.empty() && earlier.name == phase.name)
        report_.add(node->spot, fmt::format("phase '{}' is there twice (first in line {})", phase.name, earlier.place.line));
  }

  void read_repeat(const Node& node, Phase& phase) {
    if (!require_map(node, "repeat", "a map such as {max: 5, until: ...}", report_)) return;
    check_keys(node, "repeat: ", {"max", "until"}, report_);
    if (const Node* max = node.find("max")) {
      phase.repeat_max = static_cast<int>(read_integer(*max, "repeat: max", 1, kMostRepeats, report_).value_or(1));
    } else {
      report_.add(node.spot, "repeat: key 'max' is missing: how often at most?");
    }
    const Node* until = node.find("until");
    if (until == nullptr) return;
    std::vector<Phase> visible = graph_.phases;  // and the phase's own records of the repetition before
    visible.push_back(phase);
    phase.until = read_condition(*until, "until", visible, "", report_);
  }

  void read_content(Node& owner, const std::vector<Phase>& earlier, Phase& phase) {
    if (Node* node = owner.find("blocks")) read_blocks(*node, registry_, phase, report_);
    const BlockIndex blocks(phase);
    const Node* connections = owner.find("connections");
    if (connections == nullptr || !connections->broken) read_connections(connections, earlier, blocks, phase, report_);
    if (Node* node = owner.find("schedule")) read_schedule(*node, blocks, phase, report_);
    if (const Node* node = owner.find("record")) read_record(*node, blocks, phase, report_);
    if (report_.empty()) check_clock(phase);
  }

  void check_clock(const Phase& phase) {
    const std::string where = phase.name.empty() ? "" : fmt::format("phase {}: ", quote(phase.name));
    if (phase.run.clock == Clock::hardware && std::none_of(phase.blocks.begin(), phase.blocks.end(), paces))
      report_.add({phase.place, where +
                                    "run: clock 'hardware': no block of this graph paces the run (a device with streams, such as "
                                    "acquisition.alsa_capture); allowed: simulated, realtime"});
    if (phase.run.clock == Clock::simulated && phase.run.priority)
      report_.add({phase.place, where + "run: priority: a run as fast as possible would take the machine from everything else; "
                                        "allowed with clock: realtime, hardware"});
  }

  Node& root_;
  const Registry& registry_;
  Report& report_;
  Graph graph_;
  RunSettings run_;
};

}  // namespace

Graph check(Node& root, const Registry& registry, Report& report) { return Checker(root, registry, report).graph(); }

}  // namespace bodeflow::graph
