#include "graph/variables.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "graph/guard.hpp"
#include "graph/parse.hpp"

namespace bodeflow::graph {
namespace {

/// The name when the whole text is one reference, else "".
std::string only_reference(std::string_view text) {
  if (text.size() < 4 || text.substr(0, 2) != "${" || text.find('}') != text.size() - 1) return "";
  return std::string(trimmed(text.substr(2, text.size() - 3)));
}

}  // namespace

Variables::Variables(const Node* declared, Report& report) : report_(report) {
  if (declared == nullptr || declared->is_none()) return;
  if (!declared->is_map()) {
    report.add(declared->spot, fmt::format("variables: found {}, allowed: a map of names and values", what(*declared)));
    return;
  }
  for (const auto& e : declared->entries) {
    if (!is_name(e.key)) {
      report.add(e.spot, fmt::format("variables: {} is not a name: letters, digits, _ and -", quote(e.key)));
      continue;
    }
    order_.push_back(e.key);
    values_.emplace(e.key, Variable{e.value, e.spot});
  }
}

std::vector<std::string> Variables::names() const { return order_; }

void Variables::check() {
  for (const auto& name : order_) {
    Variable& variable = values_.at(name);
    if (variable.node.is_none()) {
      report_.add(variable.key, fmt::format("variable '{}' has no value: give one with --set {}=VALUE", name, name));
      variable.node.broken = true;
      variable.state = State::done;
    } else {
      finish(name, variable);
    }
  }
}

void Variables::finish(const std::string& name, Variable& variable) {
  if (variable.state != State::fresh) return;
  variable.state = State::active;
  active_.push_back(name);
  substitute(variable.node, 0);
  active_.pop_back();
  variable.state = State::done;
}

const Node* Variables::use(const std::string& name, const Spot& spot) {
  const auto found = values_.find(name);
  if (found == values_.end()) {
    const std::string hint = did_you_mean(name, names());
    report_.add(spot, fmt::format("unknown variable {}{}", quote(name), hint.empty() ? "; declared: " + listed(names()) : hint));
    return nullptr;
  }
  Variable& variable = found->second;
  if (variable.state == State::active) {
    std::string cycle;
    for (auto a = std::find(active_.begin(), active_.end(), name); a != active_.end(); ++a) cycle += *a + " -> ";
    report_.add(spot, "variables refer to each other: " + cycle + name);
    return nullptr;
  }
  if (active_.size() >= static_cast<std::size_t>(kDeepestNesting)) {
    report_.add(spot, fmt::format("variables refer to each other over more than {} levels", kDeepestNesting));
    return nullptr;
  }
  finish(name, variable);
  return variable.node.broken ? nullptr : &variable.node;
}

bool Variables::grow(std::size_t nodes, std::size_t bytes, const Spot& spot) {
  nodes_ += nodes;
  bytes_ += bytes;
  if (nodes_ <= kMostNodes && bytes_ <= kLargestFile) return true;
  if (!full_)
    report_.add(spot,
                fmt::format("the graph with its variables put in has more than {} values or {} bytes", kMostNodes, kLargestFile));
  full_ = true;
  return false;
}

void Variables::substitute(Node& node) { substitute(node, 0); }

void Variables::substitute(Node& node, int depth) {
  for (auto& item : node.items) substitute(item, depth + 1);
  for (auto& e : node.entries) substitute(e.value, depth + 1);
  if (!node.is_scalar() || node.broken || node.text.find("${") == std::string::npos) return;
  const std::string name = only_reference(node.text);
  if (name.empty()) return substitute_text(node);
  const Node* value = use(name, node.spot);
  if (value == nullptr || !grow(value->size(), 0, node.spot)) {
    node.broken = true;
    return;
  }
  if (depth + value->depth() > kDeepestNesting) {
    report_.add(node.spot, fmt::format("lists and maps are nested deeper than {} levels", kDeepestNesting));
    node.broken = true;
    return;
  }
  node = Node(*value);
}

void Variables::substitute_text(Node& node) {
  const std::string text = std::move(node.text);
  node.text.clear();
  node.exact = false;
  std::size_t at = 0;
  while (at < text.size()) {
    const auto mark = text.find("${", at);
    if (mark != std::string::npos && mark > at && text[mark - 1] == '$') {
      node.text += text.substr(at, mark - 1 - at) + "${";
      at = mark + 2;
      continue;
    }
    node.text += text.substr(at, mark == std::string::npos ? mark : mark - at);
    if (mark == std::string::npos) break;
    const auto end = text.find('}', mark);
    if (end == std::string::npos) {
      report_.add(node.spot, fmt::format("'${{' without '}}' in {}", quote(text)));
      node.broken = true;
      return;
    }
    const std::string name(trimmed(std::string_view(text).substr(mark + 2, end - mark - 2)));
    const Node* value = use(name, node.spot);
    if (value != nullptr && !value->is_scalar())
      report_.add(node.spot, fmt::format("variable '{}' is {}: it can't stand inside a text", name, what(*value)));
    at = end + 1;
    if (value == nullptr || !value->is_scalar() || !grow(0, value->text.size(), node.spot)) {
      node.broken = true;
      continue;
    }
    if (node.text.empty()) node.origin = value->origin;  // of a path, the folder comes first
    node.text += value->text;
  }
}

}  // namespace bodeflow::graph
