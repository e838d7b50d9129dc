#include "graph/ends.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bodeflow::graph {

Word word(const Node& node, std::size_t from, std::size_t length) {
  const std::string_view text(node.text);
  const std::string_view piece = text.substr(from, length);
  const std::string_view content = trimmed(piece);
  const std::size_t before = content.empty() ? from : static_cast<std::size_t>(content.data() - text.data());
  return {std::string(content), node.exact ? node.spot.right(characters(text.substr(0, before))) : node.spot};
}

std::optional<EndText> read_end(const Word& word, Report& report) {
  EndText end;
  end.spot = word.spot;
  std::string_view rest = word.text;
  end.is_reference = !rest.empty() && rest.front() == '$';
  if (end.is_reference) {
    rest.remove_prefix(1);
    const auto dot = rest.find('.');
    end.phase = std::string(rest.substr(0, dot));
    rest = dot == std::string_view::npos ? std::string_view() : rest.substr(dot + 1);
  }
  const auto dot = rest.find('.');
  end.block = std::string(rest.substr(0, dot));
  if (dot != std::string_view::npos) end.port = std::string(rest.substr(dot + 1));
  const bool port_missing = dot != std::string_view::npos && end.port.empty();
  if (end.block.empty() || port_missing || (end.is_reference && end.phase.empty())) {
    report.add(word.spot, fmt::format("found {}, allowed: block, block.port or $phase.block.port", quote(word.text)));
    return {};
  }
  return end;
}

BlockIndex::BlockIndex(const Phase& phase) : phase_(phase) {
  for (std::size_t i = 0; i < phase.blocks.size(); ++i) indices_.emplace(phase.blocks[i].name, static_cast<int>(i));
}

int BlockIndex::find(const std::string& name, const Spot& spot, Report& report) const {
  const auto found = indices_.find(name);
  if (found != indices_.end()) return found->second;
  Names names;
  for (const auto& block : phase_.blocks) names.push_back(block.name);
  const std::string hint = did_you_mean(name, names);
  constexpr std::size_t kListed = 12;  // more names than that don't help
  const bool list = hint.empty() && names.size() <= kListed;
  report.add(spot, fmt::format("unknown block {}{}", quote(name), list ? "; blocks: " + listed(names) : hint));
  return -1;
}

std::vector<const PortDescription*> ports_of(const BlockDescription& type, std::uint32_t direction, std::uint32_t kind) {
  std::vector<const PortDescription*> ports;
  for (const auto& port : type.ports)
    if (port.direction == direction && (kind == 0 || port.kind == kind)) ports.push_back(&port);
  return ports;
}

Names port_names(const std::vector<const PortDescription*>& ports) {
  Names names;
  for (const auto* port : ports) names.push_back(port->name);
  return names;
}

const PortDescription* find_port(const BlockDescription& type, const std::string& block, std::uint32_t direction,
                                 const std::string& port, const Spot& spot, Report& report) {
  if (const PortDescription* found = type.port(direction, port)) return found;
  const bool in = direction == BF_IN;
  if (type.port(in ? BF_OUT : BF_IN, port) != nullptr) {
    report.add(spot,
               fmt::format("'{}.{}' is an {}, allowed: an {}", block, port, in ? "output" : "input", in ? "input" : "output"));
    return nullptr;
  }
  const Names names = port_names(ports_of(type, direction));
  const std::string hint = did_you_mean(port, names);
  report.add(spot, fmt::format("block '{}' has no {} {}{}", block, in ? "input" : "output", quote(port),
                               hint.empty() ? fmt::format("; {}: {}", in ? "inputs" : "outputs", listed(names)) : hint));
  return nullptr;
}

std::optional<MessageOutput> find_message_output(const EndText& end, const std::vector<Phase>& phases, const std::string& current,
                                                 Report& report) {
  const auto phase = std::find_if(phases.begin(), phases.end(), [&](const Phase& p) { return p.name == end.phase; });
  if (phase == phases.end() || end.phase.empty()) {
    Names names;
    for (const auto& p : phases) names.push_back(p.name);
    if (end.phase == current)
      report.add(end.spot,
                 fmt::format("phase {} can't refer to itself here; earlier phases: {}", quote(end.phase), listed(names)));
    else
      report.add(end.spot, fmt::format("{} is no earlier phase{}; earlier phases: {}", quote(end.phase),
                                       did_you_mean(end.phase, names), listed(names)));
    return {};
  }
  const BlockIndex blocks(*phase);
  const int index = blocks.find(end.block, end.spot, report);
  if (index < 0) return {};
  const BlockDescription* type = blocks.type(index);
  if (type == nullptr) return {};
  const auto outputs = ports_of(*type, BF_OUT, BF_MESSAGE);
  const PortDescription* port = nullptr;
  if (!end.port.empty()) {
    port = find_port(*type, end.block, BF_OUT, end.port, end.spot, report);
    if (port != nullptr && port->kind != BF_MESSAGE) {
      report.add(end.spot, fmt::format("'{}.{}' is a stream: only records pass from phase to phase", end.block, end.port));
      return {};
    }
  } else if (!outputs.empty()) {
    port = outputs.front();
  } else {
    report.add(end.spot, fmt::format("block '{}' sends no records", end.block));
  }
  if (port == nullptr) return {};
  return MessageOutput{&*phase, &phase->blocks[static_cast<std::size_t>(index)], port};
}

}  // namespace bodeflow::graph
