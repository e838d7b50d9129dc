#include "graph/limits.hpp"

#include <fmt/format.h>

#include "graph/ends.hpp"
#include "graph/keys.hpp"
#include "graph/scalar.hpp"

namespace bodeflow::graph {
namespace {

OnViolation action_named(const std::string& name) {
  return name == "clamp" ? OnViolation::clamp : name == "stop" ? OnViolation::stop : OnViolation::warn;
}

class Reader {
 public:
  Reader(const Node& item, std::span<Phase> phases, Report& report) : item_(item), phases_(phases), report_(report) {}

  void read() {
    if (!require_map(item_, "limits", "a map such as {signal: drive.current, max: 12 A}", report_)) return;
    check_keys(item_, "limits: ", limit_keys(), report_);
    const Node* signal = item_.find("signal");
    if (signal == nullptr) report_.add(item_.spot, "limits: key 'signal' is missing: which stream?");
    limit_.place = item_.spot.place();
    limit_.min = quantity("min");
    limit_.max = quantity("max");
    limit_.rate = quantity("rate");
    if (item_.find("min") == nullptr && item_.find("max") == nullptr && item_.find("rate") == nullptr)
      report_.add(item_.spot, "limits: nothing is limited; allowed: at least one of min, max, rate");
    read_time();
    if (const Node* channel = item_.find("channel")) {
      limit_.channel = read_text(*channel, "limits: channel", report_).value_or("");
      limit_.channel_place = channel->spot.place();
    }
    if (const Node* side = item_.find("side")) side_ = read_choice(*side, "limits: side", {"input", "output"}, report_);
    if (const Node* action = item_.find("on_violation"))
      action_ = read_choice(*action, "limits: on_violation", violation_actions(), report_);
    if (signal != nullptr) add(*signal);
  }

 private:
  std::optional<Quantity> quantity(const char* key) {
    const Node* node = item_.find(key);
    if (node == nullptr) return {};
    if (node->is_scalar() && !node->broken) return Quantity{node->text, node->spot.place()};
    if (!node->broken)
      report_.add(node->spot,
                  fmt::format("limits: {}: found {}, allowed: a number with its unit, such as 12 A", key, what(*node)));
    return {};
  }

  void read_time() {
    const Node* node = item_.find("time");
    if (node == nullptr) return;
    limit_.time_s = read_number(*node, "limits: time", "s", report_);
    limit_.time_place = node->spot.place();
    if (limit_.time_s && *limit_.time_s <= 0.0)
      report_.add(node->spot, fmt::format("limits: time: found {}, allowed: a time above 0 s", quote(node->text)));
  }

  void add(const Node& signal) {
    if (!read_text(signal, "limits: signal", report_)) return;
    const auto end = read_end(word(signal, 0, signal.text.size()), report_);
    if (!end) return;
    if (end->is_reference) {
      report_.add(end->spot, fmt::format("limits: found {}, allowed: block or block.port", quote(signal.text)));
      return;
    }
    bool found = false;
    for (Phase& phase : phases_) {
      const int block = phase.block_index(end->block);
      if (block < 0) continue;
      found = true;
      add_to(phase, block, *end);
    }
    if (!found) unknown(*end);
  }

  void unknown(const EndText& end) {
    Names names;
    for (const Phase& phase : phases_)
      for (const Block& block : phase.blocks) names.push_back(block.name);
    const std::string hint = did_you_mean(end.block, names);
    report_.add(end.spot,
                fmt::format("limits: unknown block {}{}", quote(end.block), hint.empty() ? "; blocks: " + listed(names) : hint));
  }

  void add_to(Phase& phase, int block, const EndText& end) {
    const BlockDescription* type = phase.blocks[static_cast<std::size_t>(block)].type;
    if (type == nullptr) return;  // has problems of its own
    const PortDescription* port = find(*type, end);
    if (port == nullptr) return;
    Limit limit = limit_;
    limit.port = {block, port->index};
    limit.input = port->direction == BF_IN;
    limit.on_violation = limit.input ? OnViolation::clamp : OnViolation::stop;
    if (action_) limit.on_violation = action_named(*action_);
    if (!limit.input && limit.on_violation == OnViolation::clamp) {
      report_.add(item_.find("on_violation")->spot,
                  fmt::format("limits: '{}.{}' is an output, whose samples are there already; allowed: stop, warn, or a limit on "
                              "the input that takes them",
                              end.block, port->name));
      return;
    }
    phase.limits.push_back(std::move(limit));
  }

  /// The stream port that is meant, or nullptr: reported.
  const PortDescription* find(const BlockDescription& type, const EndText& end) {
    std::vector<const PortDescription*> ports;
    for (const std::uint32_t direction : {BF_IN, BF_OUT}) {
      if (side_ && (*side_ == "input") != (direction == BF_IN)) continue;
      for (const auto* port : ports_of(type, direction, BF_STREAM)) ports.push_back(port);
    }
    const Names names = port_names(ports);
    if (!end.port.empty()) std::erase_if(ports, [&](const PortDescription* port) { return port->name != end.port; });
    if (ports.size() == 1) return ports.front();
    const std::string streams = "; streams: " + listed(names);
    if (end.port.empty() || names.empty()) {
      report_.add(end.spot, fmt::format("limits: block '{}' ({}) has {}{}", end.block, type.id,
                                        names.empty() ? "no streams" : "several streams: name one as block.port",
                                        names.empty() ? "" : streams));
    } else if (ports.empty()) {
      const std::string hint = did_you_mean(end.port, names);
      report_.add(end.spot, fmt::format("limits: block '{}' has no stream {}{}", end.block, quote(end.port),
                                        hint.empty() ? streams : hint));
    } else {
      report_.add(end.spot, fmt::format("limits: '{}.{}' is an input and an output; say which: side: input, side: output",
                                        end.block, end.port));
    }
    return nullptr;
  }

  const Node& item_;
  std::span<Phase> phases_;
  Report& report_;
  Limit limit_;
  std::optional<std::string> side_, action_;
};

}  // namespace

void read_limits(const Node& node, std::span<Phase> phases, Report& report) {
  if (node.is_none() || !require_list(node, "limits", "a list such as [{signal: drive.current, max: 12 A}]", report)) return;
  for (const Node& item : node.items) Reader(item, phases, report).read();
}

}  // namespace bodeflow::graph
