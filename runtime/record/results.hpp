#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "graph/graph.hpp"
#include "plugins/instance.hpp"

namespace bodeflow::record {

/// The last record of every message output of a graph, in graph order.
class Results {
 public:
  explicit Results(const graph::Graph& graph);

  /// The record, empty where none was sent. An empty port is the block's first message output.
  SharedRecord last(const std::string& phase, const std::string& block, const std::string& port) const;
  /// Replaces the record; a place that the graph does not have is added at the end.
  void set(const std::string& phase, const std::string& block, const std::string& port, const SharedRecord& record);
  /// {"<phase>.<block>" or "<phase>.<block>.<port>": record}, as result.json holds it; outputs without a record are left out.
  nlohmann::ordered_json json() const;

 private:
  struct Entry {
    std::string phase, block, port;
    std::string key;
    SharedRecord record;
  };

  const Entry* find(const std::string& phase, const std::string& block, const std::string& port) const;

  std::vector<Entry> entries_;
};

}  // namespace bodeflow::record
