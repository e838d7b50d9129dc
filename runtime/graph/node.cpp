#include "graph/node.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bodeflow::graph {

Place Spot::place() const {
  if (source == nullptr) return {};
  return source->command_line ? Place{source->file, 0, 0} : Place{source->file, line, column};
}

Spot Spot::right(std::size_t count) const { return {source, line, column + static_cast<int>(count)}; }

const Entry* Node::entry(std::string_view key) const {
  for (const auto& e : entries)
    if (e.key == key) return &e;
  return nullptr;
}

const Node* Node::find(std::string_view key) const {
  const Entry* e = entry(key);
  return e == nullptr ? nullptr : &e->value;
}

Node* Node::find(std::string_view key) {
  for (auto& e : entries)
    if (e.key == key) return &e.value;
  return nullptr;
}

Node& Node::at(const std::string& key, const Spot& key_spot) {
  if (Node* found = find(key)) return *found;
  Node made;
  made.spot = key_spot;
  made.origin = key_spot.source;
  entries.push_back({key, key_spot, std::move(made)});
  return entries.back().value;
}

void Node::erase(std::string_view key) {
  std::erase_if(entries, [&](const Entry& e) { return e.key == key; });
}

std::size_t Node::size() const {
  std::size_t count = 1;
  for (const auto& item : items) count += item.size();
  for (const auto& e : entries) count += e.value.size();
  return count;
}

int Node::depth() const {
  int deepest = 0;
  for (const auto& item : items) deepest = std::max(deepest, item.depth());
  for (const auto& e : entries) deepest = std::max(deepest, e.value.depth());
  return is_list() || is_map() ? deepest + 1 : 0;
}

std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 80;
  std::string out = "'";
  std::size_t end = text.size();
  if (end > kLongest) {
    end = kLongest - 3;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  }
  for (const char c : text.substr(0, end)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      out += "\\n";
    } else if (byte < 0x20 || byte == 0x7F) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out + (end < text.size() ? "...'" : "'");
}

std::string what(const Node& node) {
  switch (node.kind) {
    case Node::Kind::none:
      return "nothing";
    case Node::Kind::scalar:
      return quote(node.text);
    case Node::Kind::list:
      return "a list";
    case Node::Kind::map:
      return "a map";
  }
  return "";
}

std::string listed(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const auto first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace bodeflow::graph
