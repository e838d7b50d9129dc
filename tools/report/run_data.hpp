#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "record/data_file.hpp"
#include "report/record.hpp"

namespace bodeflow::tools::report {

/// A block as the graph file gives it.
struct GivenBlock {
  std::string name;
  std::string id;
  std::vector<std::pair<std::string, std::string>> parameters;  ///< as written, with their units
};

struct GivenPhase {
  std::string name;                                           ///< "" in a graph without phases
  std::vector<std::pair<std::string, std::string>> settings;  ///< clock, duration, seed, when, repeat, sweep ...
  std::vector<GivenBlock> blocks;
  std::vector<std::string> connections;
};

struct LogLine {
  std::string time;
  std::string level;
  std::string text;
};

/// All that a run directory tells.
struct RunData {
  std::filesystem::path directory;
  nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
  std::vector<nlohmann::ordered_json> events;
  std::vector<LogLine> log;
  std::size_t log_lines_left_out = 0;
  std::string graph_text;
  std::vector<GivenPhase> phases;
  std::vector<Record> records;
  std::unique_ptr<record::DataFile> data;  ///< empty where data.h5 is missing or broken
  std::string status;                      ///< complete, partial, failed, running ...
  std::string reason;
  std::string title;
  std::vector<std::string> problems;  ///< what could not be read
};

/// Reads a run directory, also one that is not finished or damaged: what can't be read becomes a problem. Error: nothing there is
/// of a run.
tl::expected<RunData, std::string> read_run(const std::filesystem::path& directory);

/// Phases and blocks of a graph.yaml. Error: it is no graph.
tl::expected<std::vector<GivenPhase>, std::string> read_given(const std::string& graph_text);

/// The results that a graph.yaml wants shown, in order; none where it does not say.
std::vector<std::string> read_shown(const std::string& graph_text);

}  // namespace bodeflow::tools::report
