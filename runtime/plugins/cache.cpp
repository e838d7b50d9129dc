#include "plugins/cache.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <system_error>

#include "plugins/description_json.hpp"
#include "plugins/file_bytes.hpp"

namespace bodeflow {
namespace {

using Json = nlohmann::ordered_json;

/// What a description depends on beside the file: the last number counts the changes of its JSON form.
std::string host_version() { return fmt::format("{} abi {}.{} form 2", BODEFLOW_VERSION, BF_ABI_MAJOR, BF_ABI_MINOR); }

template <class T>
bool has_number(const Json& entry, const char* name, T value) {
  const auto it = entry.find(name);
  return it != entry.end() && it->is_number_integer() && it->get<T>() == value;
}

std::optional<PluginDescription> usable(const Json& entry, const std::string& file) {
  const auto it = entry.find("plugin");
  if (it == entry.end()) return std::nullopt;
  auto plugin = plugin_from_json(*it);
  if (!plugin || !plugin->refused.empty()) return std::nullopt;
  plugin->file = file;
  return *plugin;
}

bool write_file(const std::filesystem::path& path, const std::string& text) {
  const auto close = [](std::FILE* file) { std::fclose(file); };
  std::unique_ptr<std::FILE, decltype(close)> file(std::fopen(path.c_str(), "wb"), close);
  if (!file) return false;
  const bool written = std::fwrite(text.data(), 1, text.size(), file.get()) == text.size();
  return std::fclose(file.release()) == 0 && written;
}

}  // namespace

std::optional<FileStamp> stamp_of(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return std::nullopt;
  return FileStamp{static_cast<std::uint64_t>(info.st_size),
                   static_cast<std::int64_t>(info.st_mtim.tv_sec) * 1'000'000'000 + info.st_mtim.tv_nsec, info.st_ino};
}

ProbeCache::ProbeCache(std::filesystem::path path) : path_(std::move(path)) {
  if (path_.empty()) return;
  const auto bytes = file_bytes(path_);
  if (!bytes) return;
  const auto* begin = reinterpret_cast<const char*>(bytes->data());
  const Json json = Json::parse(begin, begin + bytes->size(), nullptr, false);
  if (!json.is_object()) return;
  const auto host = json.find("host");
  const auto files = json.find("files");
  if (host == json.end() || files == json.end() || *host != host_version() || !files->is_object()) return;
  files_ = *files;
}

const Json* ProbeCache::entry(const std::string& file) const {
  const auto it = files_.find(file);
  return it != files_.end() && it->is_object() ? &*it : nullptr;
}

std::optional<PluginDescription> ProbeCache::find(const std::string& file, const FileStamp& stamp) const {
  const Json* found = entry(file);
  if (found == nullptr || !has_number(*found, "size", stamp.size) || !has_number(*found, "modified_ns", stamp.modified_ns) ||
      !has_number(*found, "inode", stamp.inode)) {
    return std::nullopt;
  }
  return usable(*found, file);
}

std::optional<PluginDescription> ProbeCache::find(const std::string& file, const std::string& sha256) const {
  const Json* found = entry(file);
  auto plugin = found == nullptr ? std::nullopt : usable(*found, file);
  if (plugin && plugin->sha256 != sha256) plugin.reset();
  return plugin;
}

void ProbeCache::put(const PluginDescription& plugin, const FileStamp& stamp) {
  files_[plugin.file] = {
      {"size", stamp.size}, {"modified_ns", stamp.modified_ns}, {"inode", stamp.inode}, {"plugin", to_json(plugin)}};
  changed_ = true;
}

bool ProbeCache::save() {
  if (path_.empty() || !changed_) return true;
  Json kept = Json::object();
  for (const auto& [file, found] : files_.items()) {
    std::error_code unknown;
    if (std::filesystem::exists(file, unknown)) kept[file] = found;
  }
  const Json json{{"host", host_version()}, {"files", std::move(kept)}};
  std::error_code error;
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
  // A name of this process's own: another one may save at the same time, and the last rename wins as a whole.
  std::filesystem::path fresh = path_;
  fresh += fmt::format(".{}.new", ::getpid());
  const bool written = write_file(fresh, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  if (written) std::filesystem::rename(fresh, path_, error);
  if (written && !error) {
    changed_ = false;
    return true;
  }
  std::filesystem::remove(fresh, error);
  return false;
}

}  // namespace bodeflow
