#include "record/run_directory.hpp"

#include <fmt/format.h>

#include <array>
#include <mutex>
#include <system_error>

#include "plugins/sha256.hpp"
#include "record/files.hpp"
#include "record/json_text.hpp"
#include "record/limits.hpp"
#include "record/manifest.hpp"
#include "record/output_files.hpp"
#include "record/pacing.hpp"
#include "record/recorder.hpp"
#include "record/results.hpp"

namespace bodeflow::record {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Done = tl::expected<void, std::string>;

constexpr std::array<const char*, 4> kLevels = {"debug", "info", "warning", "error"};

std::string as_folder_name(std::string text) {
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '_' && c != '.') c = '_';
  return text.empty() ? "graph" : text;
}

tl::unexpected<std::string> cannot_create(const fs::path& directory, const std::error_code& error) {
  return tl::unexpected(fmt::format("can't create the run directory '{}': {}", directory.string(), error.message()));
}

/// runs/<time>-<graph>, with -2, -3 ... where several runs start in one second.
tl::expected<fs::path, std::string> new_default_directory(const std::string& graph_name) {
  std::error_code error;
  const fs::path runs = fs::current_path(error) / "runs";
  fs::create_directories(runs, error);
  if (error) return cannot_create(runs, error);
  const std::string name = fmt::format("{}-{}", folder_time_now(), as_folder_name(graph_name));
  for (int k = 1;; ++k) {
    const fs::path directory = runs / (k == 1 ? name : fmt::format("{}-{}", name, k));
    if (fs::create_directory(directory, error)) return directory;
    if (error) return cannot_create(directory, error);
  }
}

tl::expected<fs::path, std::string> given_directory(const fs::path& given) {
  std::error_code error;
  const fs::path directory = fs::absolute(given, error).lexically_normal();
  fs::create_directories(directory, error);
  if (error) return cannot_create(directory, error);
  for (const char* name : {"manifest.json", "graph.yaml", "data.h5", "events.jsonl", "result.json"})
    if (fs::exists(directory / name, error))
      return tl::unexpected(fmt::format("'{}' holds a run already; choose another directory", directory.string()));
  return directory;
}

}  // namespace

struct RunDirectory::State {
  State(fs::path directory, const graph::Graph& graph, const Options& options)
      : path(std::move(directory)),
        graph_name(options.graph_name),
        manifest(path / "manifest.json", graph, options.graph_name, options.manifest),
        outputs(path),
        results(graph) {}

  fs::path path;
  std::string graph_name;
  std::mutex mutex;  ///< of manifest and outputs
  Manifest manifest;
  OutputFiles outputs;
  LineFile events, log;
  ordered_json plans = ordered_json::array();
  Results results;
  std::unique_ptr<DataWriter> data;
  std::vector<std::unique_ptr<Recorder>> recorders;
  std::optional<graph::Phase> phase;  ///< the one that is open
  int repeat = 0;
  nlohmann::json limits;  ///< of the open phase, as planned
  std::string status = "running";
  bool closed = false;
  std::string lost;  ///< the first thing that could not be written

  void keep_first_error(const Done& done) {
    if (!done && lost.empty()) lost = done.error();
  }

  void note(const std::string& list, const nlohmann::json& item) {
    const std::lock_guard lock(mutex);
    manifest.add_item(list, item);
    keep_first_error(manifest.write());
  }

  Done write_result() const { return write_atomically(path / "result.json", json_text(result()), status != "running"); }

  ordered_json result() const {
    ordered_json json;
    json["bodeflow"] = 1;
    json["graph"] = graph_name;
    json["status"] = status;
    json["results"] = results.json();
    return json;
  }

  void event(const std::string& what, ordered_json details) {
    ordered_json line;
    line["time"] = utc_now();
    line["event"] = what;
    if (details.is_object())
      for (auto& [key, value] : details.items()) line[key] = std::move(value);
    else if (!details.is_null())
      line["details"] = std::move(details);
    events.append(json_line(line));
  }

  ordered_json phase_details() const {
    ordered_json details;
    details["phase"] = phase->name;
    details["repeat"] = repeat;
    return details;
  }

  Done add_plan(const nlohmann::json& plan) {
    ordered_json entry = phase_details();
    entry["plan"] = plan;
    for (const auto& known : plans)  // repetitions mostly have the plan of the first
      if (known["phase"] == entry["phase"] && known["plan"] == entry["plan"]) return {};
    plans.push_back(std::move(entry));
    return write_atomically(path / "plan.json", json_text({{"phases", plans}}));
  }

  /// Ends the open phase: what was recorded, its hashes, its results.
  Done end_phase(const execute::Outcome& outcome) {
    Recorder& recorder = *recorders.back();
    const Done recorded = recorder.finish();
    for (const auto& last : recorder.last_records()) results.set(phase->name, last.block, last.port, last.record);
    ordered_json details = phase_details();
    details["status"] = outcome.status == execute::Outcome::Status::complete ? "complete" : "partial";
    details["reason"] = outcome.reason;
    details["time_s"] = outcome.time_s;
    details["wall_s"] = outcome.wall_s;
    if (auto pacing = pacing_json(phase->run, outcome); !pacing.is_null()) details["pacing"] = std::move(pacing);
    if (!recorded) details["error"] = recorded.error();
    event("phase ends", std::move(details));

    const std::lock_guard lock(mutex);
    manifest.add_phase(*phase, repeat, outcome, limits_json(limits, outcome));
    manifest.add_hashes(recorder.hashes());
    recorder.let_go();
    phase.reset();
    outputs.next_phase();
    const Done written = manifest.write();
    const Done result_written = write_result();
    for (const Done* done : {&recorded, &written, &result_written}) keep_first_error(*done);
    if (!recorded) return recorded;
    return written ? result_written : written;
  }
};

RunDirectory::RunDirectory() = default;

RunDirectory::~RunDirectory() {
  if (state_ && !state_->closed) (void)close("partial", "the run was not closed");
}

tl::expected<std::unique_ptr<RunDirectory>, std::string> RunDirectory::create(const Options& options, const graph::Graph& graph) {
  const auto directory =
      options.directory.empty() ? new_default_directory(options.graph_name) : given_directory(options.directory);
  if (!directory) return tl::unexpected(directory.error());

  auto state = std::make_unique<State>(*directory, graph, options);
  Done done = state->manifest.create();
  if (done) done = write_atomically(*directory / "graph.yaml", graph.expanded);
  if (done) done = state->events.open(*directory / "events.jsonl");
  if (done) done = state->log.open(*directory / "log.txt");
  if (!done) return tl::unexpected(done.error());
  state->event("run begins", {{"graph", options.graph_name}});
  std::unique_ptr<RunDirectory> run(new RunDirectory);
  run->state_ = std::move(state);
  return run;
}

const fs::path& RunDirectory::path() const { return state_->path; }

void RunDirectory::event(const std::string& what, nlohmann::json details) { state_->event(what, std::move(details)); }

void RunDirectory::log(const std::string& block, int level, const std::string& text) {
  const bool known = level >= 0 && level < static_cast<int>(kLevels.size());
  std::string line = fmt::format("{} {} {}: ", utc_now(), known ? kLevels[static_cast<std::size_t>(level)] : "info", block);
  for (const char c : text) line += c == '\n' ? std::string("\n  ") : std::string(1, c);
  state_->log.append(std::move(line));
}

void RunDirectory::note_input(const std::string& block, const std::string& path) {
  const std::lock_guard lock(state_->mutex);
  if (state_->manifest.add_input(block, path)) state_->keep_first_error(state_->manifest.write());
}

tl::expected<std::string, std::string> RunDirectory::output_path(const std::string& block, const std::string& name) {
  const std::lock_guard lock(state_->mutex);
  return state_->outputs.claim(block, name);
}

tl::expected<execute::Sink*, std::string> RunDirectory::begin_phase(const graph::Phase& phase, const plan::Facts& facts,
                                                                    const nlohmann::json& plan, int repeat) {
  State& state = *state_;
  if (!state.data) {
    auto data = DataWriter::create(state.path / "data.h5");
    if (!data) return tl::unexpected(data.error());
    state.data = std::move(*data);
  }
  auto recorder = Recorder::begin(phase, facts, repeat, *state.data, [&state](const std::string& what, ordered_json details) {
    state.event(what, std::move(details));
  });
  if (!recorder) return tl::unexpected(recorder.error());
  state.recorders.push_back(std::move(*recorder));
  state.phase = phase;
  state.repeat = repeat;
  state.limits = plan.is_object() ? plan.value("limits", nlohmann::json()) : nlohmann::json();
  state.event("phase begins", state.phase_details());
  if (const Done planned = state.add_plan(plan); !planned) {
    state.keep_first_error(planned);
    return tl::unexpected(planned.error());
  }
  return state.recorders.back().get();
}

tl::expected<void, std::string> RunDirectory::end_phase(const execute::Outcome& outcome) {
  if (!state_->phase) return {};
  return state_->end_phase(outcome);
}

SharedRecord RunDirectory::last_record(const std::string& phase, const std::string& block, const std::string& port) const {
  return state_->results.last(phase, block, port);
}

void RunDirectory::set_result(const std::string& phase, const std::string& block, const std::string& port,
                              const SharedRecord& record) {
  state_->results.set(phase, block, port, record);
}

void RunDirectory::add_host(const std::string& host, const graph::Phase& phase, int repeat, const nlohmann::json& end) {
  const std::lock_guard lock(state_->mutex);
  state_->manifest.add_host(host, phase, repeat, end);
  state_->keep_first_error(state_->manifest.write());
}

void RunDirectory::add_hashes(const std::vector<std::pair<std::string, std::string>>& hashes) {
  const std::lock_guard lock(state_->mutex);
  state_->manifest.add_hashes(hashes);
}

void RunDirectory::note_gap(const nlohmann::json& gap) {
  event("gap", gap);
  state_->note("gaps", gap);
}

void RunDirectory::note_restart(const nlohmann::json& restart) {
  event("host goes on", restart);
  state_->note("restarts", restart);
}

tl::expected<void, std::string> RunDirectory::close(const std::string& status, const std::string& reason) {
  State& state = *state_;
  if (state.closed) return {};
  state.closed = true;
  if (state.phase) {
    execute::Outcome outcome;
    outcome.status = execute::Outcome::Status::partial;
    outcome.reason = reason;
    (void)state.end_phase(outcome);
  }
  state.data.reset();  // gives back the space that it holds on the disk
  state.status = status;
  state.event("run ends", {{"status", status}, {"reason", reason}});
  state.keep_first_error(state.write_result());
  {
    const std::lock_guard lock(state.mutex);
    for (const auto& [name, file] : state.outputs.files())
      if (const auto hash = sha256_of_file(file)) state.manifest.add_hashes({{"files/" + name, *hash}});
    state.manifest.end(status, reason);
    state.keep_first_error(state.manifest.write(true));
  }
  for (const LineFile* file : {&state.events, &state.log})
    if (state.lost.empty()) state.lost = file->error();
  if (!state.lost.empty()) return tl::unexpected(state.lost);
  return {};
}

ordered_json RunDirectory::result() const { return state_->result(); }

}  // namespace bodeflow::record
