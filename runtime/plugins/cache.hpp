#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "plugins/description.hpp"

namespace bodeflow {

/// What tells without reading it that a file is still the same.
struct FileStamp {
  std::uint64_t size = 0;
  std::int64_t modified_ns = 0;
  std::uint64_t inode = 0;

  bool operator==(const FileStamp&) const = default;
};

/// The stamp of a file, or nothing when it can't be looked at.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// The descriptions of usable plugins between two starts, a JSON file for one host version. A file that is absent, broken or
/// of another version is an empty cache.
class ProbeCache {
 public:
  /// Reads the file; an empty path: no cache.
  explicit ProbeCache(std::filesystem::path path);

  /// The description of `file` if its stamp is the noted one.
  std::optional<PluginDescription> find(const std::string& file, const FileStamp& stamp) const;
  /// The description of `file` if its SHA-256 is the noted one. Any thread, as long as nobody calls `put`.
  std::optional<PluginDescription> find(const std::string& file, const std::string& sha256) const;

  void put(const PluginDescription& plugin, const FileStamp& stamp);

  /// Writes the file if anything was put, as a whole or not at all; false when it can't be written.
  bool save();

 private:
  const nlohmann::ordered_json* entry(const std::string& file) const;

  std::filesystem::path path_;
  nlohmann::ordered_json files_ = nlohmann::ordered_json::object();  // by path: size, modified_ns, inode, plugin
  bool changed_ = false;
};

}  // namespace bodeflow
