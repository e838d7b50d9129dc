#pragma once

#include <optional>
#include <string>
#include <unordered_map>

#include "graph/graph.hpp"
#include "graph/keys.hpp"
#include "graph/node.hpp"

namespace bodeflow::graph {

/// A piece of a text with its place.
struct Word {
  std::string text;
  Spot spot;
};

/// The piece [from, from + length) of a scalar's text, blanks around it removed.
Word word(const Node& node, std::size_t from, std::size_t length);

/// `block`, `block.port` or `$phase.block.port` as written.
struct EndText {
  bool is_reference = false;
  std::string phase, block, port;
  Spot spot;
};

/// Nothing: reported.
std::optional<EndText> read_end(const Word& word, Report& report);

/// The blocks of a phase by name.
class BlockIndex {
 public:
  explicit BlockIndex(const Phase& phase);
  /// Index of a block, or -1: reported with the nearest name.
  int find(const std::string& name, const Spot& spot, Report& report) const;
  /// The description of a block, or nullptr when it has problems of its own.
  const BlockDescription* type(int block) const { return phase_.blocks[static_cast<std::size_t>(block)].type; }
  const std::string& name(int block) const { return phase_.blocks[static_cast<std::size_t>(block)].name; }
  const Phase& phase() const { return phase_; }

 private:
  const Phase& phase_;
  std::unordered_map<std::string, int> indices_;
};

/// Ports of a direction, by kind where it is not 0.
std::vector<const PortDescription*> ports_of(const BlockDescription& type, std::uint32_t direction, std::uint32_t kind = 0);
Names port_names(const std::vector<const PortDescription*>& ports);

/// The port of that name, or nullptr: reported, with what stands there instead.
const PortDescription* find_port(const BlockDescription& type, const std::string& block, std::uint32_t direction,
                                 const std::string& port, const Spot& spot, Report& report);

/// A message output of a phase.
struct MessageOutput {
  const Phase* phase = nullptr;
  const Block* block = nullptr;
  const PortDescription* port = nullptr;
};

/// What `$phase.block[.port]` means; the port may be left out: the first output for records is meant. `phases` are those that may
/// be referred to, `current` the phase in which the reference stands. Nothing: reported.
std::optional<MessageOutput> find_message_output(const EndText& end, const std::vector<Phase>& phases, const std::string& current,
                                                 Report& report);

}  // namespace bodeflow::graph
