#include "lab/collect.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "record/join.hpp"

namespace bodeflow::lab {
namespace {

namespace fs = std::filesystem;

/// What every run directory has; all else was written by blocks.
bool is_own_file(const fs::path& name) {
  static const std::array<const char*, 7> kOwn = {"manifest.json", "graph.yaml",  "events.jsonl", "log.txt",
                                                  "plan.json",     "result.json", "data.h5"};
  for (const char* own : kOwn)
    if (name == own) return true;
  return false;
}

/// Whether a block is one of the engine's own, at the end of a connection between hosts: those are named after it.
bool is_end(const std::string& name) { return name.find(" -> ") != std::string::npos; }

/// The hashes of a host's manifest, without those of the ends of connections between hosts.
std::vector<std::pair<std::string, std::string>> hashes_of(const fs::path& manifest) {
  std::vector<std::pair<std::string, std::string>> hashes;
  std::ifstream in(manifest);
  const nlohmann::ordered_json json = nlohmann::ordered_json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("hashes")) return hashes;
  for (const auto& [name, hash] : json["hashes"].items())
    if (hash.is_string() && !is_end(name)) hashes.emplace_back(name, hash.get<std::string>());
  return hashes;
}

tl::expected<void, std::string> copy_outputs(const fs::path& host, const fs::path& into) {
  for (const auto& entry : fs::recursive_directory_iterator(host)) {
    const fs::path name = fs::relative(entry.path(), host);
    if (!entry.is_regular_file() || is_own_file(name)) continue;
    if (fs::exists(into / name)) return tl::unexpected(fmt::format("'{}' was written on two hosts", name.string()));
    fs::create_directories((into / name).parent_path());
    fs::copy_file(entry.path(), into / name);
  }
  return {};
}

}  // namespace

tl::expected<void, std::string> merge_hosts(record::RunDirectory& directory) {
  const fs::path hosts = directory.path() / "hosts";
  if (!fs::exists(hosts)) return {};
  std::vector<fs::path> folders, recordings;
  for (const auto& entry : fs::directory_iterator(hosts))
    if (entry.is_directory()) folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  try {
    for (const fs::path& folder : folders) {
      if (fs::exists(folder / "data.h5")) recordings.push_back(folder / "data.h5");
      directory.add_hashes(hashes_of(folder / "manifest.json"));
      if (auto copied = copy_outputs(folder, directory.path()); !copied) return copied;
    }
    if (auto joined =
            record::join_data(recordings, directory.path() / "data.h5", [](const std::string& block) { return !is_end(block); });
        !joined)
      return joined;
    for (const fs::path& recording : recordings) fs::remove(recording);
  } catch (const fs::filesystem_error& error) {
    return tl::unexpected(std::string("can't join what the hosts sent: ") + error.what());
  }
  return {};
}

}  // namespace bodeflow::lab
