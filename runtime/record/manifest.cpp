#include "record/manifest.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "plugins/sha256.hpp"
#include "record/files.hpp"
#include "record/json_text.hpp"
#include "record/pacing.hpp"
#include "record/run_directory.hpp"

namespace bodeflow::record {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Of this file's own layout; the layout of result.json is stated there.
constexpr int kSchema = 1;

ordered_json host() {
  utsname names{};
  ordered_json json;
  if (::uname(&names) != 0) return json;
  json["name"] = names.nodename;
  json["system"] = fmt::format("{} {}", names.sysname, names.release);
  json["machine"] = names.machine;
  return json;
}

}  // namespace

Manifest::Manifest(fs::path file, const graph::Graph& graph, const std::string& graph_name, const nlohmann::json& given)
    : file_(std::move(file)) {
  json_["schema"] = kSchema;
  json_["graph"] = graph_name;
  json_["graph_file"] = graph.file;
  json_["title"] = graph.title;
  json_["status"] = "running";
  json_["reason"] = "";
  json_["started"] = utc_now();
  json_["ended"] = nullptr;
  json_["host"] = host();
  if (given.is_object())
    for (const auto& [key, value] : given.items())
      if (!json_.contains(key)) json_[key] = value;
  json_["inputs"] = ordered_json::array();
  json_["phases"] = ordered_json::array();
  json_["hashes"] = ordered_json::object();
}

tl::expected<void, std::string> Manifest::create() {
  const int file = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST)
    return tl::unexpected(fmt::format("'{}' holds a run already; choose another directory", file_.parent_path().string()));
  if (file < 0) return tl::unexpected(fmt::format("can't write '{}': {}", file_.string(), std::strerror(errno)));
  ::close(file);
  return write();
}

tl::expected<void, std::string> Manifest::write(bool durable) { return write_atomically(file_, json_text(json_), durable); }

bool Manifest::add_input(const std::string& block, const std::string& path) {
  std::error_code error;
  fs::path absolute = fs::weakly_canonical(path, error);
  if (error) absolute = path;
  ordered_json& inputs = json_["inputs"];
  for (auto& input : inputs) {
    if (input["path"] != absolute.string()) continue;
    ordered_json& blocks = input["blocks"];
    if (std::find(blocks.begin(), blocks.end(), block) != blocks.end()) return false;
    blocks.push_back(block);
    return true;
  }
  ordered_json input;
  input["path"] = absolute.string();
  input["blocks"] = {block};
  const auto hash = sha256_of_file(absolute);
  const auto size = fs::file_size(absolute, error);
  if (hash && !error) {
    input["size"] = size;
    input["sha256"] = *hash;
  } else {
    input["error"] = hash ? error.message() : hash.error();
  }
  inputs.push_back(std::move(input));
  return true;
}

void Manifest::add_phase(const graph::Phase& phase, int repeat, const execute::Outcome& outcome, ordered_json limits) {
  ordered_json entry;
  entry["phase"] = phase.name;
  entry["repeat"] = repeat;
  entry["status"] = outcome.status == execute::Outcome::Status::complete ? "complete" : "partial";
  entry["interrupted"] = outcome.interrupted;
  entry["reason"] = outcome.reason;
  entry["failed_block"] = nullptr;
  if (outcome.failed_block >= 0) entry["failed_block"] = phase.blocks[static_cast<std::size_t>(outcome.failed_block)].name;
  entry["time_s"] = outcome.time_s;
  entry["wall_s"] = outcome.wall_s;
  if (auto pacing = pacing_json(phase.run, outcome); !pacing.is_null()) entry["pacing"] = std::move(pacing);
  if (!limits.is_null()) entry["limits"] = std::move(limits);
  ordered_json blocks = ordered_json::object();
  for (std::size_t b = 0; b < std::min(phase.blocks.size(), outcome.metrics.size()); ++b) {
    const auto& metrics = outcome.metrics[b];
    ordered_json& block = blocks[phase.blocks[b].name];
    block["calls"] = metrics.calls;
    block["firings"] = metrics.firings;
    block["seconds"] = metrics.seconds;
    block["dropped"] = metrics.dropped;
  }
  entry["blocks"] = std::move(blocks);
  json_["phases"].push_back(std::move(entry));
}

void Manifest::add_host(const std::string& host, const graph::Phase& phase, int repeat, const nlohmann::json& end) {
  ordered_json entry;
  entry["host"] = host;
  entry["phase"] = phase.name;
  entry["repeat"] = repeat;
  entry["status"] = end.value("complete", false) ? "complete" : "partial";
  for (const char* key : {"time_s", "wall_s", "pacing"})
    if (end.contains(key) && !end[key].is_null()) entry[key] = end[key];
  json_["hosts"].push_back(std::move(entry));
}

void Manifest::add_hashes(const std::vector<std::pair<std::string, std::string>>& hashes) {
  for (const auto& [key, hash] : hashes) json_["hashes"][key] = hash;
}

void Manifest::end(const std::string& status, const std::string& reason) {
  json_["status"] = status;
  json_["reason"] = reason;
  json_["ended"] = utc_now();
}

}  // namespace bodeflow::record
