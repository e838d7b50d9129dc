#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "execute/execute.hpp"

namespace bodeflow::record {

/// manifest.json: what is needed to read a run and to repeat it. It exists from the start, with the status "running".
class Manifest {
 public:
  /// `given`: the caller's own fields; they stand first and can't replace ours.
  Manifest(std::filesystem::path file, const graph::Graph& graph, const std::string& graph_name, const nlohmann::json& given);

  /// Claims the file: it must not exist. Error: why not, with its path.
  tl::expected<void, std::string> create();
  tl::expected<void, std::string> write(bool durable = false);

  /// The size and SHA-256 of a file that a block reads, or why it can't be read; false: it is known already.
  bool add_input(const std::string& block, const std::string& path);
  /// `limits`: as limits_json gives them.
  void add_phase(const graph::Phase& phase, int repeat, const execute::Outcome& outcome, nlohmann::ordered_json limits);
  /// How a host of a run over hosts ended its part of a phase, in its words: complete, time_s, wall_s, pacing.
  void add_host(const std::string& host, const graph::Phase& phase, int repeat, const nlohmann::json& end);
  void add_hashes(const std::vector<std::pair<std::string, std::string>>& hashes);
  /// One more item of a list.
  void add_item(const std::string& list, const nlohmann::ordered_json& item) { json_[list].push_back(item); }
  void end(const std::string& status, const std::string& reason);

 private:
  std::filesystem::path file_;
  nlohmann::ordered_json json_;
};

}  // namespace bodeflow::record
