#include "graph/keys.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bodeflow::graph {

const Names& graph_keys() {
  static const Names kKeys = {"bodeflow",    "title",    "run",    "include", "requires", "variables", "blocks",
                              "connections", "schedule", "record", "limits",  "phases",   "hosts",     "summary"};
  return kKeys;
}

const Names& phase_keys() {
  static const Names kKeys = {"name", "blocks", "connections", "schedule", "record", "limits", "run", "when", "repeat", "sweep"};
  return kKeys;
}

const Names& run_keys() {
  static const Names kKeys = {"clock",    "duration", "seed",     "chunk",     "latency",       "threads", "on_overrun",
                              "priority", "cores",    "watchdog", "tolerance", "launcher_lost", "restart", "gaps"};
  return kKeys;
}

const Names& limit_keys() {
  static const Names kKeys = {"signal", "side", "channel", "min", "max", "rate", "time", "on_violation"};
  return kKeys;
}

const Names& violation_actions() {
  static const Names kActions = {"clamp", "stop", "warn"};
  return kActions;
}

const Names& clocks() {
  static const Names kClocks = {"simulated", "realtime", "hardware"};
  return kClocks;
}

const Names& overruns() {
  static const Names kOverruns = {"count", "skip", "stop"};
  return kOverruns;
}

void check_keys(const Node& map, const std::string& where, const Names& allowed, Report& report) {
  for (const auto& e : map.entries) {
    if (std::find(allowed.begin(), allowed.end(), e.key) != allowed.end()) continue;
    const std::string hint = did_you_mean(e.key, allowed);
    report.add(e.spot,
               fmt::format("{}unknown key {}{}", where, quote(e.key), hint.empty() ? "; allowed: " + listed(allowed) : hint));
  }
}

namespace {

bool require(bool is, const Node& node, const std::string& where, const std::string& allowed, Report& report) {
  if (!is && !node.broken) report.add(node.spot, fmt::format("{}: found {}, allowed: {}", where, what(node), allowed));
  return is;
}

}  // namespace

bool require_map(const Node& node, const std::string& where, const std::string& allowed, Report& report) {
  return require(node.is_map(), node, where, allowed, report);
}

bool require_list(const Node& node, const std::string& where, const std::string& allowed, Report& report) {
  return require(node.is_list(), node, where, allowed, report);
}

}  // namespace bodeflow::graph
