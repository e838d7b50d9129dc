#include "graph/blocks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "graph/keys.hpp"
#include "graph/value.hpp"

namespace bodeflow::graph {
namespace {

/// Walks nested maps down to the names that the description has.
class Flattener {
 public:
  Flattener(const BlockDescription& type, const std::string& owner, Report& report)
      : type_(type), owner_(owner), report_(report), first_(type.parameters.size(), nullptr) {}

  void walk(Node& map, const std::string& prefix, const std::string& skip) {
    for (auto& e : map.entries) {
      if (prefix.empty() && e.key == skip) continue;
      const std::string name = prefix + e.key;
      const int index = type_.parameter(name);
      if (index >= 0) {
        keep(index, e);
      } else if (e.value.is_map() && is_group(name)) {
        walk(e.value, name + ".", skip);
      } else {
        unknown(name, e);
      }
    }
  }

  std::vector<WrittenParameter> take() { return std::move(out_); }

 private:
  bool is_group(const std::string& name) const {
    return std::any_of(type_.parameters.begin(), type_.parameters.end(),
                       [&](const ParameterDescription& p) { return p.name.compare(0, name.size() + 1, name + ".") == 0; });
  }

  void keep(int index, Entry& e) {
    Node*& first = first_[static_cast<std::size_t>(index)];
    if (first == nullptr) {
      first = &e.value;
      out_.push_back({index, &e.value});
      return;
    }
    const auto from_command_line = [](const Node& node) { return node.spot.source != nullptr && node.spot.source->command_line; };
    if (from_command_line(e.value)) {  // --set by another name of the parameter
      first->dropped = true;
      first = &e.value;
      for (auto& written : out_)
        if (written.index == index) written.node = first;
      return;
    }
    if (from_command_line(*first)) {
      e.value.dropped = true;
      return;
    }
    report_.add(e.spot, fmt::format("{}: parameter '{}' is given twice (first in line {})", owner_,
                                    type_.parameters[static_cast<std::size_t>(index)].name, first->spot.line));
  }

  void unknown(const std::string& name, const Entry& e) {
    std::vector<std::string> names;
    for (const auto& p : type_.parameters) names.push_back(p.name);
    const std::string hint = did_you_mean(name, names);
    report_.add(e.spot, fmt::format("{}: unknown parameter {}{}", owner_, quote(name),
                                    hint.empty() ? "; parameters: " + listed(names) : hint));
  }

  const BlockDescription& type_;
  const std::string& owner_;
  Report& report_;
  std::vector<Node*> first_;
  std::vector<WrittenParameter> out_;
};

const BlockDescription* find_type(const Node& node, const Spot& spot, const std::string& owner, const Registry& registry,
                                  Report& report) {
  const Entry* id = node.entry("block");
  if (id == nullptr) {
    report.add(spot, fmt::format("{}: key 'block' is missing: which block is it?", owner));
    return nullptr;
  }
  if (id->value.broken) return nullptr;
  if (!id->value.is_scalar()) {
    report.add(id->value.spot, fmt::format("{}: block: found {}, allowed: the id of a block", owner, what(id->value)));
    return nullptr;
  }
  const std::string& name = id->value.text;
  if (const BlockDescription* type = registry.find(name)) return type;
  std::string why = did_you_mean(name, registry.ids());
  const std::string family = name.substr(0, name.find('.'));
  for (const auto& plugin : registry.plugins())
    if (!plugin.refused.empty() && plugin.name == family)
      why += fmt::format("; plugin '{}' can't be used: {}", family, plugin.refused);
  report.add(id->value.spot, fmt::format("{}: unknown block {}{}", owner, quote(name), why));
  return nullptr;
}

/// The parameter that tells the unit of a block's numbers, or -1.
int unit_of(const BlockDescription& type) {
  const int index = type.parameter("unit");
  return index >= 0 && type.parameters[static_cast<std::size_t>(index)].type == BF_STRING ? index : -1;
}

void read_parameters(Node& node, const Spot& spot, const std::string& owner, Block& block, Report& report) {
  const auto& described = block.type->parameters;
  for (const auto& p : described) block.parameters.push_back(p.fallback);
  block.parameter_places.assign(described.size(), block.place);
  std::vector<bool> given(described.size(), false);
  const auto all = written_parameters(node, *block.type, owner, "block", report);
  const auto unit =
      std::find_if(all.begin(), all.end(), [&](const auto& written) { return written.index == unit_of(*block.type); });
  const std::string own = unit != all.end() && unit->node->is_scalar() ? unit->node->text : "";
  for (const auto& written : all) {
    const auto i = static_cast<std::size_t>(written.index);
    given[i] = true;
    block.parameter_places[i] = written.node->spot.place();
    const std::string where = fmt::format("{}: parameter '{}'", owner, described[i].name);
    if (auto value = read_parameter(*written.node, described[i], where, report, own)) block.parameters[i] = std::move(*value);
  }
  for (std::size_t i = 0; i < described.size(); ++i)
    if (described[i].required && !given[i])
      report.add(spot, fmt::format("{}: parameter '{}' is missing: {}", owner, described[i].name, allowed_form(described[i])));
}

}  // namespace

std::string own_unit(const Block& block) {
  const int index = unit_of(*block.type);
  if (index < 0) return "";
  const auto& texts = block.parameters[static_cast<std::size_t>(index)].strings;
  return texts.empty() ? "" : texts.front();
}

std::vector<WrittenParameter> written_parameters(Node& node, const BlockDescription& type, const std::string& owner,
                                                 const std::string& skip, Report& report) {
  Flattener flattener(type, owner, report);
  flattener.walk(node, "", skip);
  return flattener.take();
}

void read_blocks(Node& node, const Registry& registry, Phase& phase, Report& report) {
  if (!require_map(node, "blocks", "a map of names and blocks", report)) return;
  phase.blocks.reserve(node.entries.size());
  for (auto& e : node.entries) {
    const std::string owner = fmt::format("block {}", quote(e.key));
    if (!is_name(e.key)) report.add(e.spot, fmt::format("{} is not a name: letters, digits, _ and -", owner));
    Block block;
    block.name = e.key;
    block.place = e.spot.place();
    if (require_map(e.value, owner, "a map such as {block: filters.gain, gain: 2}", report) && !e.value.broken) {
      block.type = find_type(e.value, e.spot, owner, registry, report);
      if (block.type != nullptr) read_parameters(e.value, e.spot, owner, block, report);
    }
    phase.blocks.push_back(std::move(block));
  }
}

}  // namespace bodeflow::graph
