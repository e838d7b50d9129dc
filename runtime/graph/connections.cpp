#include "graph/connections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "graph/keys.hpp"
#include "graph/scalar.hpp"

namespace bodeflow::graph {
namespace {

/// What one side of an arrow may be, before the other side decides.
struct Side {
  EndText text;
  int block = -1;
  bool parameters = false;                      ///< the implicit input for changes of parameters
  std::vector<const PortDescription*> choices;  ///< one where the port is named
};

std::string shown(const Place& place) {
  return place.line > 0 ? fmt::format("{}:{}:{}", place.file, place.line, place.column) : place.file;
}

const char* element_name(std::uint32_t element) { return element == BF_F64 ? "f64" : element == BF_C64 ? "c64" : "any"; }

class Wiring {
 public:
  Wiring(const std::vector<Phase>& earlier, const BlockIndex& blocks, Phase& phase, Report& report)
      : earlier_(earlier), blocks_(blocks), phase_(phase), report_(report) {}

  void read(const Node& connections) {
    if (connections.is_none() || !require_list(connections, "connections", "a list such as [a -> b]", report_)) return;
    for (const auto& item : connections.items) {
      if (item.broken) unsure_ = true;
      if (item.broken) continue;
      if (item.is_map()) {
        read_map(item);
      } else if (item.is_scalar()) {
        read_chain(item);
      } else {
        unsure_ = true;
        report_.add(item.spot, fmt::format("connections: found {}, allowed: 'a -> b' or {{from: a, to: b}}", what(item)));
      }
    }
  }

  void check_unconnected() {
    if (unsure_) return;
    for (std::size_t b = 0; b < phase_.blocks.size(); ++b) {
      const Block& block = phase_.blocks[b];
      if (block.type == nullptr || failed_.count(static_cast<int>(b)) != 0) continue;
      for (const auto* port : ports_of(*block.type, BF_IN)) {
        const auto key = std::tuple(static_cast<int>(b), port->kind, port->index);
        if (!port->optional && connected_.count(key) == 0)
          missing_.push_back({block.place, fmt::format("block '{}': {} '{}' is not connected", block.name,
                                                       port->kind == BF_STREAM ? "input" : "message input", port->name)});
      }
    }
  }

  const Problems& missing() const { return missing_; }

 private:
  void read_chain(const Node& item) {
    std::vector<EndText> ends;
    std::size_t from = 0;
    const std::string& text = item.text;
    if (text.find("->") == std::string::npos) {
      report_.add(item.spot, fmt::format("connections: found {}, allowed: 'a -> b'", quote(text)));
      unsure_ = true;
      return;
    }
    bool complete = true;
    while (from <= text.size()) {
      const auto arrow = std::min(text.find("->", from), text.size());
      const Word piece = word(item, from, arrow - from);
      if (piece.text.empty()) {
        report_.add(piece.spot, fmt::format("an end is missing in {}, allowed: 'a -> b'", quote(text)));
        complete = false;
      } else if (auto end = read_end(piece, report_)) {
        ends.push_back(std::move(*end));
      } else {
        complete = false;
      }
      from = arrow + 2;
    }
    if (!complete) {
      unsure_ = true;
      return;
    }
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      EndText left = ends[i], right = ends[i + 1];
      if ((i > 0 && !split_middle(left, true)) || (i + 2 < ends.size() && !split_middle(right, false))) {
        unsure_ = true;
      } else {
        connect(left, right, {}, nullptr);
      }
    }
  }

  /// A port of a block within a chain is its input or its output; the other side is then the block's only one. False: reported.
  bool split_middle(EndText& end, bool as_output) {
    if (end.is_reference) {
      if (as_output) return false;  // the step before has reported it
      report_.add(end.spot, "a record of an earlier phase stands at the beginning of a connection");
      return false;
    }
    if (end.port.empty()) return true;
    Report quiet;
    const int block = blocks_.find(end.block, end.spot, quiet);
    const BlockDescription* type = block < 0 ? nullptr : blocks_.type(block);
    if (type == nullptr) return true;
    const bool in = type->port(BF_IN, end.port) != nullptr, out = type->port(BF_OUT, end.port) != nullptr;
    if (in && out) {
      if (!as_output)
        report_.add(end.spot, fmt::format("'{}.{}' is an input and an output: write two connections", end.block, end.port));
      return false;
    }
    if (!in && !out) return !as_output;  // reported once, as an input
    if (in == as_output) end.port.clear();
    return true;
  }

  void read_map(const Node& item) {
    check_keys(item, "connection: ", {"from", "to", "latency"}, report_);
    std::optional<EndText> ends[2];
    for (const int i : {0, 1}) {
      const char* key = i == 0 ? "from" : "to";
      const Node* node = item.find(key);
      if (node == nullptr) {
        report_.add(item.spot, fmt::format("connection: key '{}' is missing", key));
      } else if (read_text(*node, fmt::format("connection: {}", key), report_)) {
        ends[i] = read_end(word(*node, 0, node->text.size()), report_);
      }
    }
    const Node* node = item.find("latency");
    std::optional<Latency> latency = Latency{};
    if (node != nullptr) latency = read_latency(*node);
    if (ends[0] && ends[1] && latency) {
      connect(*ends[0], *ends[1], *latency, node);
    } else {
      unsure_ = true;
    }
  }

  std::optional<Latency> read_latency(const Node& node) {
    const auto text = read_text(node, "connection: latency", report_);
    if (!text) return {};
    const std::string_view content = trimmed(*text);
    for (const std::string_view unit : {" samples", " sample"}) {
      if (content.size() <= unit.size() || content.substr(content.size() - unit.size()) != unit) continue;
      const auto count = integer_of(content.substr(0, content.size() - unit.size()));
      if (count && *count >= 0) return Latency{Rate{0, 1}, *count};
      report_.add(node.spot, fmt::format("connection: latency: {}",
                                         count ? fmt::format("found {}, allowed: 0 samples or more", *count) : count.error()));
      return {};
    }
    const auto seconds = read_number(node, "connection: latency", "s", report_);
    if (!seconds) return {};
    const Rate exact = Rate::from_hz(*seconds);
    if (*seconds < 0.0 || (*seconds > 0.0 && exact.num == 0)) {
      report_.add(node.spot, fmt::format("connection: latency: found {}, allowed: 0 s or more, or whole samples", quote(*text)));
      return {};
    }
    return Latency{exact, 0};
  }

  bool resolve(Side& side, std::uint32_t direction) {
    const EndText& text = side.text;
    side.block = blocks_.find(text.block, text.spot, report_);
    const BlockDescription* type = side.block < 0 ? nullptr : blocks_.type(side.block);
    if (type == nullptr) return false;
    const bool in = direction == BF_IN;
    if (text.port.empty()) {
      side.choices = ports_of(*type, direction);
      if (side.choices.empty())
        report_.add(text.spot, fmt::format("block '{}' ({}) has no {}", text.block, type->id, in ? "inputs" : "outputs"));
      return !side.choices.empty();
    }
    if (in && text.port == "parameters" && type->port(BF_IN, text.port) == nullptr) {
      side.parameters =
          std::any_of(type->parameters.begin(), type->parameters.end(), [](const ParameterDescription& p) { return p.live; });
      if (!side.parameters)
        report_.add(text.spot,
                    fmt::format("block '{}' ({}) has no live parameters, nothing can change them", text.block, type->id));
      return side.parameters;
    }
    const PortDescription* port = find_port(*type, text.block, direction, text.port, text.spot, report_);
    if (port != nullptr) side.choices = {port};
    return port != nullptr;
  }

  void fail(const Side& side) {
    if (side.block >= 0) failed_.insert(side.block);
    if (side.block < 0) unsure_ = true;
  }

  void connect(const EndText& from, const EndText& to, const Latency& latency, const Node* latency_node) {
    Side left{from, -1, false, {}}, right{to, -1, false, {}};
    if (to.is_reference) {
      report_.add(to.spot, "a record of an earlier phase stands at the beginning of a connection");
      return;
    }
    if (from.is_reference) return refer(from, right, latency_node);
    const bool left_good = resolve(left, BF_OUT), right_good = resolve(right, BF_IN);
    if (!left_good || !right_good) return fail(right);
    if (!choose(left, right)) return fail(right);
    const PortDescription& out = *left.choices.front();
    const End out_end{left.block, out.index};
    const Place place = from.spot.place();
    if (right.parameters) {
      if (!out.record_type.empty() && out.record_type != "parameter_change")
        report_.add(from.spot, fmt::format("'{}' sends records of type '{}', '{}.parameters' takes 'parameter_change'",
                                           name(left), out.record_type, to.block));
      return add_message({out_end, {right.block, kParameterPort}, latency, place}, to);
    }
    const PortDescription& in = *right.choices.front();
    connected_.emplace(std::tuple(right.block, in.kind, in.index), place);
    if (out.kind == BF_STREAM) {
      if (latency_node != nullptr)
        report_.add(latency_node->spot, "connection: latency: only connections of records have one; use a delay block");
      return add_stream({out_end, {right.block, in.index}, place}, left, right);
    }
    check_record(out.record_type, in.record_type, name(left), name(right), from.spot);
    add_message({out_end, {right.block, in.index}, latency, place}, to);
  }

  static std::string name(const Side& side) { return side.text.block + "." + side.choices.front()->name; }

  void check_record(const std::string& sent, const std::string& taken, const std::string& from, const std::string& to,
                    const Spot& spot) {
    if (!sent.empty() && !taken.empty() && sent != taken)
      report_.add(spot, fmt::format("'{}' sends records of type '{}', '{}' takes '{}'", from, sent, to, taken));
  }

  /// Leaves one port on either side; false: reported.
  bool choose(Side& left, Side& right) {
    if (right.parameters) return choose_kind(left, BF_MESSAGE, BF_OUT, right.text.block + ".parameters");
    if (left.choices.size() == 1 && right.choices.size() == 1) {
      const PortDescription &out = *left.choices.front(), &in = *right.choices.front();
      if (out.kind == in.kind) return true;
      report_.add(left.text.spot, out.kind == BF_STREAM
                                      ? fmt::format("'{}' is a stream, '{}' takes records", name(left), name(right))
                                      : fmt::format("'{}' sends records, '{}' takes a stream", name(left), name(right)));
      return false;
    }
    std::vector<std::uint32_t> kinds;
    for (const std::uint32_t kind : {BF_STREAM, BF_MESSAGE})
      if (count(left, kind) > 0 && count(right, kind) > 0) kinds.push_back(kind);
    if (kinds.empty()) {
      const bool stream = left.choices.front()->kind == BF_STREAM;
      report_.add(left.text.spot, fmt::format("{} gives {}, {} takes {}", described(left), stream ? "a stream" : "records",
                                              described(right), stream ? "records" : "a stream"));
      return false;
    }
    if (kinds.size() > 1) return ambiguous(left.choices.size() > 1 ? left : right, left.choices.size() > 1);
    keep(left, kinds.front());
    keep(right, kinds.front());
    prefer_needed(right);
    if (kinds.front() == BF_MESSAGE) left.choices.resize(1);  // of several records the first is the block's result
    if (left.choices.size() > 1) return ambiguous(left, true);
    return right.choices.size() > 1 ? ambiguous(right, false) : true;
  }

  bool choose_kind(Side& side, std::uint32_t kind, std::uint32_t direction, const std::string& other) {
    if (count(side, kind) == 0) {
      report_.add(side.text.spot, fmt::format("{} gives a stream, '{}' takes records", described(side), other));
      return false;
    }
    keep(side, kind);
    return side.choices.size() == 1 ? true : ambiguous(side, direction == BF_OUT);
  }

  static std::string described(const Side& side) {
    return side.choices.size() == 1 ? "'" + name(side) + "'" : "block '" + side.text.block + "'";
  }

  static std::size_t count(const Side& side, std::uint32_t kind) {
    return static_cast<std::size_t>(
        std::count_if(side.choices.begin(), side.choices.end(), [&](const auto* p) { return p->kind == kind; }));
  }

  static void keep(Side& side, std::uint32_t kind) {
    std::erase_if(side.choices, [&](const auto* p) { return p->kind != kind; });
  }

  /// Of several inputs, the one that must be connected is meant where there is exactly one.
  static void prefer_needed(Side& side) {
    const auto needed = [](const auto* p) { return !p->optional; };
    if (std::count_if(side.choices.begin(), side.choices.end(), needed) == 1)
      std::erase_if(side.choices, [&](const auto* p) { return !needed(p); });
  }

  bool ambiguous(const Side& side, bool outputs) {
    report_.add(side.text.spot, fmt::format("block '{}' has several {}: {}; write '{}.{}' or another", side.text.block,
                                            outputs ? "outputs" : "inputs", listed(port_names(side.choices)), side.text.block,
                                            side.choices.front()->name));
    return false;
  }

  void add_stream(StreamEdge edge, const Side& left, const Side& right) {
    const std::uint32_t given = left.choices.front()->element, taken = right.choices.front()->element;
    if (given != BF_ANY && taken != BF_ANY && given != taken)
      report_.add(left.text.spot,
                  fmt::format("'{}' gives {}, '{}' takes {}", name(left), element_name(given), name(right), element_name(taken)));
    const auto [first, is_new] = stream_inputs_.try_emplace(std::pair(edge.to.block, edge.to.port), edge.place);
    if (!is_new) {
      report_.add(right.text.spot, fmt::format("input '{}' is connected twice (first at {})", name(right), shown(first->second)));
      return;
    }
    phase_.streams.push_back(std::move(edge));
  }

  void add_message(MessageEdge edge, const EndText& to) {
    const auto key = std::tuple(edge.from.block, edge.from.port, edge.to.block, edge.to.port);
    const auto [first, is_new] = message_edges_.try_emplace(key, edge.place);
    if (!is_new) {
      report_.add(to.spot, fmt::format("this connection is there twice (first at {})", shown(first->second)));
      return;
    }
    phase_.messages.push_back(std::move(edge));
  }

  void refer(const EndText& from, Side& right, const Node* latency_node) {
    if (latency_node != nullptr)
      report_.add(latency_node->spot, "connection: latency: a record of an earlier phase is there from the beginning");
    const auto source = find_message_output(from, earlier_, phase_.name, report_);
    if (!resolve(right, BF_IN)) return fail(right);
    End to{right.block, kParameterPort};
    std::string taken = "parameter_change";
    if (!right.parameters) {
      const Side all = right;
      keep(right, BF_MESSAGE);
      if (right.choices.empty()) {
        report_.add(right.text.spot, fmt::format("'{}.{}' takes a stream, only records pass from phase to phase",
                                                 right.text.block, all.choices.front()->name));
        return fail(right);
      }
      if (right.choices.size() > 1) {
        ambiguous(right, false);
        return fail(right);
      }
      const PortDescription& in = *right.choices.front();
      to.port = in.index;
      taken = in.record_type;
      connected_.emplace(std::tuple(right.block, in.kind, in.index), from.spot.place());
    }
    if (!source) return;
    const std::string port = right.parameters ? "parameters" : right.choices.front()->name;
    const auto swept = [&](const Phase& p) { return p.name == from.phase && !p.sweep.empty(); };
    const bool merged = std::any_of(earlier_.begin(), earlier_.end(), swept);  // of its runs: one record
    check_record(merged ? "sweep" : source->port->record_type, taken,
                 fmt::format("${}.{}.{}", from.phase, from.block, source->port->name), right.text.block + "." + port, from.spot);
    phase_.references.push_back({from.phase, from.block, source->port->name, to, from.spot.place()});
  }

  const std::vector<Phase>& earlier_;
  const BlockIndex& blocks_;
  Phase& phase_;
  Report& report_;
  std::map<std::pair<int, int>, Place> stream_inputs_;
  std::map<std::tuple<int, int, int, int>, Place> message_edges_;
  std::map<std::tuple<int, std::uint32_t, int>, Place> connected_;
  std::set<int> failed_;  ///< blocks with a wrong connection: what they lack is not known
  bool unsure_ = false;   ///< a connection could not be read: an unconnected input would be a guess
  Problems missing_;
};

}  // namespace

void read_connections(const Node* node, const std::vector<Phase>& earlier, const BlockIndex& blocks, Phase& phase,
                      Report& report) {
  Wiring wiring(earlier, blocks, phase, report);
  if (node != nullptr) wiring.read(*node);
  wiring.check_unconnected();
  for (const auto& problem : wiring.missing()) report.add(problem);
}

}  // namespace bodeflow::graph
