#pragma once

#include <map>
#include <string>

#include "graph/node.hpp"

namespace bodeflow::graph {

/// The `variables` of a graph: puts their values in the place of `${name}`. `$${` stands for the text `${`.
class Variables {
 public:
  /// `declared`: the node of the key `variables`, or nullptr.
  Variables(const Node* declared, Report& report);

  std::vector<std::string> names() const;
  bool has(const std::string& name) const { return values_.count(name) != 0; }
  /// The value of a declared variable, to be set before the first use.
  Node& value(const std::string& name) { return values_.at(name).node; }

  /// Reports variables without a value and bad references between variables.
  void check();
  /// Replaces the references in a subtree.
  void substitute(Node& node);

 private:
  enum class State { fresh, active, done };
  struct Variable {
    Node node;
    Spot key;
    State state = State::fresh;
  };

  void substitute(Node& node, int depth);
  void substitute_text(Node& node);
  /// The finished value, or nullptr (reported at `spot`).
  const Node* use(const std::string& name, const Spot& spot);
  void finish(const std::string& name, Variable& variable);
  bool grow(std::size_t nodes, std::size_t bytes, const Spot& spot);

  Report& report_;
  std::map<std::string, Variable> values_;
  std::vector<std::string> order_;   ///< as declared
  std::vector<std::string> active_;  ///< being finished, outermost first
  std::size_t nodes_ = 0, bytes_ = 0;
  bool full_ = false;
};

}  // namespace bodeflow::graph
