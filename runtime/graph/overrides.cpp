#include "graph/overrides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bodeflow/utf8.hpp>
#include <filesystem>

#include "graph/keys.hpp"
#include "graph/parse.hpp"

namespace bodeflow::graph {
namespace {

using Words = std::vector<std::string>;

Words split(const std::string& path) {
  Words words(1);
  for (const char c : path) {
    if (c == '.') {
      words.emplace_back();
    } else {
      words.back() += c;
    }
  }
  return words;
}

std::string joined(const Words& words, std::size_t count) {
  return fmt::format("{}", fmt::join(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(count), "."));
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Walks down from `node`, making maps where nothing is, and puts the value there.
void set_below(Node& node, const Words& words, std::size_t from, const Node& value, Report& report) {
  if (from == words.size()) {
    node = Node(value);
    return;
  }
  if (node.is_none()) {
    node.kind = Node::Kind::map;
    node.flow = true;
  }
  if (!node.is_map()) {
    if (!node.broken)
      report.add(value.spot, fmt::format("{} is {}, there is nothing below it", quote(joined(words, from)), what(node)));
    return;
  }
  set_below(node.at(words[from], value.spot), words, from + 1, value, report);
}

Node* phase_named(Node& root, const std::string& name) {
  Node* phases = root.find("phases");
  if (phases == nullptr) return nullptr;
  for (auto& phase : phases->items) {
    const Node* own = phase.find("name");
    if (own != nullptr && own->is_scalar() && own->text == name) return &phase;
  }
  return nullptr;
}

std::vector<std::string> keys_of(const Node* map) {
  std::vector<std::string> keys;
  if (map != nullptr)
    for (const auto& e : map->entries) keys.push_back(e.key);
  return keys;
}

/// Every `blocks` of the document.
std::vector<Node*> block_maps(Node& root) {
  std::vector<Node*> maps;
  if (Node* blocks = root.find("blocks")) maps.push_back(blocks);
  if (Node* phases = root.find("phases"))
    for (auto& phase : phases->items)
      if (Node* blocks = phase.find("blocks")) maps.push_back(blocks);
  return maps;
}

class Setter {
 public:
  Setter(const Override& override_, const Variables& variables, Node& root, Report& report)
      : words_(override_.path), value_(override_.value), variables_(variables), root_(root), report_(report) {}

  void set() {
    if (words_[0] == "phases" && words_.size() > 1) return set_in_phase(1);
    if (Node* phase = phase_named(root_, words_[0]); phase != nullptr && words_.size() > 1 && belongs_to(*phase))
      return set_in_phase(0);
    if (set_in_blocks()) return;
    if (contains(graph_keys(), words_[0])) return set_at_top();
    unknown();
  }

 private:
  bool belongs_to(const Node& phase) const {
    const Node* blocks = phase.find("blocks");
    return contains(phase_keys(), words_[1]) || (blocks != nullptr && blocks->find(words_[1]) != nullptr) ||
           block_maps_with(words_[0]).empty();
  }

  std::vector<Node*> block_maps_with(const std::string& name) const {
    std::vector<Node*> maps = block_maps(root_);
    std::erase_if(maps, [&](const Node* blocks) { return blocks->find(name) == nullptr; });
    return maps;
  }

  bool set_in_blocks() {
    if (contains(graph_keys(), words_[0])) return false;
    const std::vector<Node*> maps = block_maps_with(words_[0]);
    for (Node* blocks : maps) set_below(*blocks->find(words_[0]), words_, 1, value_, report_);
    return !maps.empty();
  }

  void set_at_top() {
    if (words_[0] == "blocks" && words_.size() > 1) return set_block(root_, 1);
    set_below(root_, words_, 0, value_, report_);
  }

  /// words_[at] is the phase.
  void set_in_phase(std::size_t at) {
    Node* phase = phase_named(root_, words_[at]);
    if (phase == nullptr || at + 1 == words_.size()) return unknown();
    if (words_[at + 1] == "blocks" && words_.size() > at + 2) return set_block(*phase, at + 2);
    if (contains(phase_keys(), words_[at + 1])) return set_below(*phase, words_, at + 1, value_, report_);
    set_block(*phase, at + 1);
  }

  /// words_[at] is a block of the map below `owner.blocks`.
  void set_block(Node& owner, std::size_t at) {
    Node* blocks = owner.find("blocks");
    Node* block = blocks == nullptr ? nullptr : blocks->find(words_[at]);
    if (block == nullptr) {
      const auto known = keys_of(blocks);
      const std::string hint = did_you_mean(words_[at], known);
      report_.add(value_.spot,
                  fmt::format("unknown block {}{}", quote(words_[at]), hint.empty() ? "; blocks: " + listed(known) : hint));
      return;
    }
    set_below(*block, words_, at + 1, value_, report_);
  }

  void unknown() {
    std::vector<std::string> known = variables_.names();
    for (Node* blocks : block_maps(root_))
      for (auto& key : keys_of(blocks)) known.push_back(key);
    if (const Node* phases = root_.find("phases"))
      for (const auto& phase : phases->items)
        if (const Node* name = phase.find("name"); name != nullptr && name->is_scalar()) known.push_back(name->text);
    for (const auto& key : graph_keys()) known.push_back(key);
    const std::size_t at = words_[0] == "phases" && words_.size() > 1 ? 1 : 0;
    report_.add(value_.spot, fmt::format("{} is no variable, block, phase or key of the graph{}", quote(words_[at]),
                                         did_you_mean(words_[at], known)));
  }

  const Words& words_;
  const Node& value_;
  const Variables& variables_;
  Node& root_;
  Report& report_;
};

/// Printable and not long: it is the place in messages.
std::string shown(const std::string& assignment) {
  const std::string quoted = quote(is_text(assignment) ? assignment : "?");
  return quoted.substr(1, quoted.size() - 2);
}

void put_in_run(Node& owner, const std::string& key, const std::string& text, const Source& source, bool make) {
  Node* run = owner.find("run");
  if (run == nullptr && !make) return;
  Node& place = run != nullptr ? *run : owner.at("run", {&source, 0, 0});
  if (place.is_none()) place.kind = Node::Kind::map;
  if (!place.is_map() || (!make && place.find(key) == nullptr)) return;
  Node value;
  value.kind = Node::Kind::scalar;
  value.text = text;
  value.spot = {&source, 0, 0};
  value.origin = &source;
  place.at(key, value.spot) = value;
}

}  // namespace

std::vector<Override> read_overrides(const std::vector<std::pair<std::string, std::string>>& overrides, Document& document,
                                     Report& report) {
  std::vector<Override> out;
  std::error_code error;
  const std::string here = std::filesystem::current_path(error).string();
  for (const auto& [path, text] : overrides) {
    const Source& source = document.add_source("--set " + shown(path + "=" + text), here, true);
    Node value;
    value.spot = {&source, 0, 0};
    value.origin = &source;
    if (!is_text(path) || !is_text(text)) {
      report.add(value.spot, "not UTF-8");
      continue;
    }
    const Words words = split(path);
    if (std::any_of(words.begin(), words.end(), [](const std::string& word) { return word.empty(); })) {
      report.add(value.spot, fmt::format("{} is not a path: words with dots between them", quote(path)));
      continue;
    }
    if (words.size() > static_cast<std::size_t>(kDeepestNesting)) {
      report.add(value.spot, fmt::format("the path is deeper than {} levels", kDeepestNesting));
      continue;
    }
    const std::string_view content = trimmed(text);
    if (!content.empty() && (content.front() == '[' || content.front() == '{')) {
      auto parsed = parse(text, source, report);
      if (!parsed) continue;
      value = std::move(*parsed);
    } else if (!content.empty()) {
      value.kind = Node::Kind::scalar;
      value.text = std::string(content);
    }
    out.push_back({words, std::move(value)});
  }
  return out;
}

void set_variables(std::vector<Override>& overrides, Variables& variables, Report& report) {
  std::erase_if(overrides, [&](const Override& o) {
    const std::size_t at = o.path[0] == "variables" && o.path.size() > 1 ? 1 : 0;  // a variable, or its path in the file
    if (!variables.has(o.path[at])) return false;
    set_below(variables.value(o.path[at]), o.path, at + 1, o.value, report);
    return true;
  });
}

void apply(const std::vector<Override>& overrides, const Variables& variables, Node& root, Report& report) {
  for (const auto& o : overrides) Setter(o, variables, root, report).set();
}

void apply_run_key(const std::string& key, const std::string& text, const Source& source, Node& root) {
  put_in_run(root, key, text, source, true);
  if (Node* phases = root.find("phases"))
    for (auto& phase : phases->items)
      if (phase.is_map()) put_in_run(phase, key, text, source, false);
}

}  // namespace bodeflow::graph
