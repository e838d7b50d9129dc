#include "graph/expand.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bodeflow::graph {
namespace {

constexpr std::size_t kLongestLine = 120;

bool is_plain_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_./+-$<>=%^() ").find(c) != std::string_view::npos;
}

/// True when the text may stand without quotes and is read as the same text.
bool is_plain(const std::string& text, bool in_flow) {
  constexpr std::string_view kNothing[] = {"~", "null", "Null", "NULL"};
  if (text.empty() || text.front() == ' ' || text.back() == ' ') return false;
  if (std::find(std::begin(kNothing), std::end(kNothing), text) != std::end(kNothing)) return false;
  if (!std::all_of(text.begin(), text.end(), [&](char c) { return is_plain_character(c) || (c == ',' && !in_flow); }))
    return false;
  if (text.front() == '-' || text.front() == '+')
    return text.size() > 1 && (text[1] == '.' || (text[1] >= '0' && text[1] <= '9'));
  return std::string_view("<>=%^(").find(text.front()) == std::string_view::npos && text.front() != ',' &&
         text.compare(0, 3, "...") != 0;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7F) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

/// `${` in a finished text is no reference any more.
std::string escaped(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 2, "${") == 0) out += '$';
    out += text[i];
  }
  return out;
}

std::string scalar(const std::string& text, bool in_flow) { return is_plain(text, in_flow) ? text : quoted(escaped(text)); }

std::string key(const std::string& text) { return is_plain(text, true) ? text : quoted(text); }

void flow(const Node& node, std::string& out) {
  bool first = true;
  const auto comma = [&] {
    if (!first) out += ", ";
    first = false;
  };
  switch (node.kind) {
    case Node::Kind::none:
      out += "null";
      return;
    case Node::Kind::scalar:
      out += scalar(node.text, true);
      return;
    case Node::Kind::list:
      out += '[';
      for (const auto& item : node.items) {
        comma();
        flow(item, out);
      }
      out += ']';
      return;
    case Node::Kind::map:
      out += '{';
      for (const auto& e : node.entries) {
        if (e.value.dropped) continue;
        comma();
        out += key(e.key) + ": ";
        flow(e.value, out);
      }
      out += '}';
      return;
  }
}

/// Writes nodes at an indentation; the line is begun by the caller.
class Writer {
 public:
  void map(const Node& node, std::size_t indent, bool first_line_begun) {
    for (const auto& e : node.entries) {
      if (e.value.dropped) continue;
      if (!first_line_begun) out_.append(indent, ' ');
      first_line_begun = false;
      out_ += key(e.key) + ":";
      value(e.value, indent, false);
    }
  }

  std::string take() { return std::move(out_); }

 private:
  void value(const Node& node, std::size_t indent, bool in_list) {
    const bool empty =
        (node.is_list() && node.items.empty()) ||
        (node.is_map() && std::all_of(node.entries.begin(), node.entries.end(), [](const Entry& e) { return e.value.dropped; }));
    if (node.is_scalar() || node.is_none() || empty || node.flow) {
      std::string line;
      if (node.is_scalar()) line = scalar(node.text, false);
      if (!node.is_scalar()) flow(node, line);
      if (node.is_scalar() || node.is_none() || empty || line.size() + indent <= kLongestLine) {
        out_ += " " + line + "\n";
        return;
      }
    }
    if (node.is_map()) {
      out_ += in_list ? " " : "\n";
      map(node, indent + 2, in_list);
      return;
    }
    if (in_list) {  // a list in a list begins a line of its own: "- - a" is hard to read
      out_ += "\n";
      list(node, indent + 2);
      return;
    }
    out_ += "\n";
    list(node, indent + 2);
  }

  void list(const Node& node, std::size_t indent) {
    for (const auto& item : node.items) {
      out_.append(indent, ' ');
      out_ += "-";
      value(item, indent, true);
    }
  }

  std::string out_;
};

}  // namespace

std::string to_yaml(const Node& root) {
  Writer writer;
  writer.map(root, 0, false);
  return writer.take();
}

std::string flow_text(const Node& node) {
  std::string out;
  flow(node, out);
  return out;
}

}  // namespace bodeflow::graph
