#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "execute/execute.hpp"

namespace bodeflow::record {

/// Where a run is kept: graph.yaml, plan.json, manifest.json, events.jsonl, log.txt, data.h5, result.json.
/// Everything is written as it comes, so that a killed run leaves what it had.
class RunDirectory {
 public:
  struct Options {
    std::filesystem::path directory;  ///< as given by --out; empty: runs/<time>-<graph> below the working directory
    std::string graph_name;           ///< file name without extension
    nlohmann::json manifest;          ///< what the caller knows: versions, plugins, seed, command line options ...
  };

  /// Creates the folder (it must not hold a run already) and writes graph.yaml and manifest.json.
  static tl::expected<std::unique_ptr<RunDirectory>, std::string> create(const Options& options, const graph::Graph& graph);
  ~RunDirectory();

  const std::filesystem::path& path() const;

  /// A line of events.jsonl; a time stamp is added.
  void event(const std::string& what, nlohmann::json details = {});
  /// A line of log.txt.
  void log(const std::string& block, int level, const std::string& text);
  /// An input file of a block: its size and SHA-256 go into the manifest (once a file).
  void note_input(const std::string& block, const std::string& path);
  /// The absolute path for a block's output file inside the directory; refuses absolute paths, `..`, and repeats.
  tl::expected<std::string, std::string> output_path(const std::string& block, const std::string& name);

  /// Opens the recording of a phase's run (`repeat` counts from 0) in data.h5; the sink lives until the directory is closed.
  tl::expected<execute::Sink*, std::string> begin_phase(const graph::Phase& phase, const plan::Facts& facts,
                                                        const nlohmann::json& plan, int repeat);
  /// Ends it: hashes of streams and records go into the manifest, last records of message outputs into result.json.
  tl::expected<void, std::string> end_phase(const execute::Outcome& outcome);

  /// The last record of `phase`'s `block.port`, for references and conditions; empty when there is none.
  SharedRecord last_record(const std::string& phase, const std::string& block, const std::string& port) const;
  /// Puts a record into the results (merged sweeps).
  void set_result(const std::string& phase, const std::string& block, const std::string& port, const SharedRecord& record);

  /// As Manifest::add_host.
  void add_host(const std::string& host, const graph::Phase& phase, int repeat, const nlohmann::json& end);
  /// Adds hashes that were made elsewhere (the runs of a sweep) to the manifest's.
  void add_hashes(const std::vector<std::pair<std::string, std::string>>& hashes);

  /// Notes in the manifest and the events that samples are missing in a stream.
  void note_gap(const nlohmann::json& gap);
  /// Notes there that a part of the run goes on for a lost one.
  void note_restart(const nlohmann::json& restart);

  /// Writes result.json and the manifest's closing part; hashes the files that blocks wrote. `status`: "complete", "partial" or
  /// "failed".
  tl::expected<void, std::string> close(const std::string& status, const std::string& reason);

  /// What result.json holds.
  nlohmann::ordered_json result() const;

 private:
  RunDirectory();
  struct State;
  std::unique_ptr<State> state_;
};

/// A record as the JSON of result.json: {"type", "attributes", "arrays"}; complex as [re, im], non-finite as null.
nlohmann::ordered_json to_json(const SharedRecord& record);
/// And back, for records that come from a result.json (references of a repeated phase, sweep workers). Error: why not.
tl::expected<SharedRecord, std::string> record_from_json(const nlohmann::ordered_json& json);

}  // namespace bodeflow::record
