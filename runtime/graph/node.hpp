#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "graph/problem.hpp"

namespace bodeflow::graph {

/// A file, or one --set of the command line, that nodes were read from.
struct Source {
  std::string file;           ///< as messages name it
  std::string folder;         ///< absolute: relative paths written in the source start here
  bool command_line = false;  ///< has no lines
};

/// Where a node stands; cheap to copy. The source outlives it.
struct Spot {
  const Source* source = nullptr;
  int line = 0;
  int column = 0;

  Place place() const;
  /// The spot so many characters further right.
  Spot right(std::size_t characters) const;
};

struct Entry;

/// One node of a YAML document. Scalars keep their text: what it means is decided where it is used.
struct Node {
  enum class Kind { none, scalar, list, map };

  Kind kind = Kind::none;
  bool quoted = false;
  bool flow = false;     ///< written with [] or {}
  bool exact = false;    ///< the text stands in the file as it is here: columns inside it can be told
  bool broken = false;   ///< a problem was reported already: readers keep silent
  bool dropped = false;  ///< another entry took its place (--set by an alias): not part of the expanded text
  Spot spot;
  const Source* origin = nullptr;  ///< what a relative path in the text is relative to
  std::string text;
  std::vector<Node> items;
  std::vector<Entry> entries;

  bool is_none() const { return kind == Kind::none; }
  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_list() const { return kind == Kind::list; }
  bool is_map() const { return kind == Kind::map; }

  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);
  const Entry* entry(std::string_view key) const;
  /// The value of a key, made empty at the end where absent.
  Node& at(const std::string& key, const Spot& key_spot);
  void erase(std::string_view key);
  /// Nodes in this subtree, itself included.
  std::size_t size() const;
  /// Levels of lists and maps; 0 for a scalar.
  int depth() const;
};

struct Entry {
  std::string key;
  Spot spot;
  Node value;
};

/// Collects problems.
class Report {
 public:
  void add(Problem problem) { problems_.push_back(std::move(problem)); }
  void add(const Spot& spot, std::string text) { problems_.push_back({spot.place(), std::move(text)}); }
  bool empty() const { return problems_.empty(); }
  std::size_t size() const { return problems_.size(); }
  const Problems& problems() const { return problems_; }

 private:
  Problems problems_;
};

/// 'text' for messages: one line, printable, shortened when long.
std::string quote(std::string_view text);

/// "nothing", "'text'", "a list", "a map".
std::string what(const Node& node);

/// "a, b, c", or "none".
std::string listed(const std::vector<std::string>& names);

/// Characters (not bytes) of a UTF-8 text.
std::size_t characters(std::string_view text);

/// True for names of blocks, phases, variables and hosts: letters, digits, _ and -.
bool is_name(std::string_view text);

std::string_view trimmed(std::string_view text);

}  // namespace bodeflow::graph
