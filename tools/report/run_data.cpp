#include "report/run_data.hpp"

#include <fmt/format.h>

#include <fstream>
#include <set>

#include "record/files.hpp"
#include "report/result_file.hpp"

namespace bodeflow::tools::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::size_t kMostLines = 2000;       ///< of the log, and of events
constexpr std::size_t kMostText = 16U << 20U;  ///< bytes of a file that is read whole

std::string text_in(const ordered_json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

/// A file of moderate size; nothing, with a problem, where it can't be read.
std::string read_small(const fs::path& path, std::vector<std::string>& problems) {
  std::error_code error;
  if (!fs::exists(path, error)) return "";
  if (const auto size = fs::file_size(path, error); error || size > kMostText) {
    problems.push_back(fmt::format("{} is left out: {}", path.filename().string(),
                                   error ? error.message() : fmt::format("it is larger than {} MB", kMostText >> 20U)));
    return "";
  }
  auto text = record::read_text(path);
  if (text) return std::move(*text);
  problems.push_back(text.error());
  return "";
}

void read_manifest(RunData& run) {
  const std::string text = read_small(run.directory / "manifest.json", run.problems);
  if (text.empty()) {
    run.problems.emplace_back("manifest.json is missing or empty: versions, inputs and host are not known");
    return;
  }
  auto manifest = ordered_json::parse(text, nullptr, false);
  if (!manifest.is_object()) {
    run.problems.emplace_back("manifest.json is damaged: versions, inputs and host are not known");
    return;
  }
  run.manifest = std::move(manifest);
  run.status = text_in(run.manifest, "status");
  run.reason = text_in(run.manifest, "reason");
  run.title = text_in(run.manifest, "title");
}

void read_graph(RunData& run) {
  run.graph_text = read_small(run.directory / "graph.yaml", run.problems);
  if (run.graph_text.empty()) {
    run.problems.emplace_back("graph.yaml is missing or empty: what was done can't be told");
    return;
  }
  auto given = read_given(run.graph_text);
  if (given)
    run.phases = std::move(*given);
  else
    run.problems.push_back(given.error());
}

void read_events(RunData& run) {
  std::ifstream file(run.directory / "events.jsonl");
  for (std::string line; run.events.size() < kMostLines && std::getline(file, line);) {
    auto event = ordered_json::parse(line, nullptr, false);
    if (event.is_object()) run.events.push_back(std::move(event));
  }
}

/// "2026-11-22T04:31:15.303Z info text".
void read_log(RunData& run) {
  std::ifstream file(run.directory / "log.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) continue;
    if (run.log.size() >= kMostLines) {
      ++run.log_lines_left_out;
      continue;
    }
    const auto first = line.find(' ');
    const auto second = first == std::string::npos ? first : line.find(' ', first + 1);
    if (second == std::string::npos || first < 10 || line[4] != '-')
      run.log.push_back({"", "", line});
    else
      run.log.push_back({line.substr(0, first), line.substr(first + 1, second - first - 1), line.substr(second + 1)});
  }
}

void open_data(RunData& run) {
  std::error_code error;
  const fs::path path = run.directory / "data.h5";
  if (!fs::exists(path, error)) return;
  auto opened = record::DataFile::open(path);
  if (opened)
    run.data = std::move(*opened);
  else
    run.problems.push_back(opened.error());
}

/// The last record of each message output: what a run that was killed had got so far.
void records_from_data(RunData& run) {
  if (!run.data) return;
  for (const auto& stored : run.data->records()) {
    if (stored.count == 0) continue;
    const auto last = run.data->read(stored, stored.count - 1, 1);
    if (!last) {
      run.problems.push_back(last.error());
      continue;
    }
    const auto& bytes = last->front().record;
    const std::string port = stored.origin.port == "out" ? "" : "." + stored.origin.port;
    const std::string phase = stored.origin.phase.empty() ? "" : stored.origin.phase + ".";
    run.records.push_back(record_of(phase + stored.origin.block + port, RecordView(bytes.bytes())));
  }
}

void read_results(RunData& run) {
  std::error_code error;
  if (!fs::exists(run.directory / "result.json", error)) {
    run.problems.emplace_back("result.json is missing: the run did not end by itself; its last records come from data.h5");
    records_from_data(run);
    return;
  }
  auto result = read_result(run.directory / "result.json");
  if (!result) {
    run.problems.push_back(result.error());
    return;
  }
  run.records = std::move(result->records);
  for (auto& problem : result->problems) run.problems.push_back(std::move(problem));
  if (run.status.empty() || run.status == "running") run.status = result->status;
}

}  // namespace

tl::expected<RunData, std::string> read_run(const fs::path& directory) {
  std::error_code error;
  if (!fs::is_directory(directory, error)) return tl::unexpected(fmt::format("'{}' is no folder", directory.string()));
  bool any = false;
  for (const char* name : {"result.json", "manifest.json", "data.h5"}) any |= fs::exists(directory / name, error);
  if (!any)
    return tl::unexpected(
        fmt::format("'{}' is no run directory: it has no result.json, manifest.json or data.h5", directory.string()));
  RunData run;
  run.directory = directory;
  read_manifest(run);
  read_graph(run);
  read_events(run);
  read_log(run);
  open_data(run);
  read_results(run);
  if (run.status.empty()) run.status = "unknown";
  if (run.status == "running") run.status = "not finished";
  return run;
}

}  // namespace bodeflow::tools::report
