#include "plugins/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "plugins/cache.hpp"
#include "plugins/description_json.hpp"
#include "plugins/elf_note.hpp"
#include "plugins/file_bytes.hpp"
#include "plugins/library.hpp"
#include "plugins/probe.hpp"
#include "plugins/sha256.hpp"

namespace bodeflow {
namespace {

namespace fs = std::filesystem;

/// Children that are probed at the same time: two keep two cores busy without crowding out a running experiment.
constexpr std::size_t kProbes = 2;

/// The plugin files of the search path, absolute, each once, in the path's order and by name within a folder.
std::vector<fs::path> find_files(const std::vector<fs::path>& path) {
  std::vector<fs::path> found;
  std::set<fs::path> seen;
  const auto add = [&](const fs::path& file) {
    std::error_code error;
    fs::path real = fs::canonical(file, error);
    if (error) real = fs::absolute(file, error);
    if (seen.insert(real).second) found.push_back(std::move(real));
  };
  for (const fs::path& place : path) {
    std::error_code error;
    if (fs::is_regular_file(place, error)) {
      add(place);
      continue;
    }
    std::vector<fs::path> files;
    for (fs::directory_iterator it(place, error), end; !error && it != end; it.increment(error)) {
      std::error_code unknown;
      if (it->path().extension() == ".so" && it->is_regular_file(unknown)) files.push_back(it->path());
    }
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) add(file);
  }
  return found;
}

/// A file that the cache does not know by its stamp: read, checked by its note, hashed, and probed unless its hash is known.
PluginDescription examine(const fs::path& file, const ProbeCache& cache, const Registry::Options& options) {
  PluginDescription plugin;
  plugin.file = file.string();
  const auto refuse = [&](const std::string& why) {
    plugin.refused = why;
    return plugin;
  };
  const auto bytes = file_bytes(file);
  if (!bytes) return refuse(bytes.error());
  const auto note = read_elf_note(*bytes);
  if (!note) return refuse(note.error());
  plugin.name = note->name;
  plugin.version = note->version;
  plugin.build = note->build;
  if (const std::string why = abi_problem(note->abi_major, note->abi_minor); !why.empty()) return refuse(why);
  plugin.sha256 = sha256_hex(*bytes);
  if (auto known = cache.find(plugin.file, plugin.sha256)) return *known;
  PluginDescription probed = probe(file, options.probe_command, options.probe_timeout_s);
  probed.sha256 = plugin.sha256;
  if (!probed.refused.empty()) return refuse(probed.refused);
  return probed;
}

/// `examine`, with whatever the host itself fails at as the reason.
PluginDescription examine_safely(const fs::path& file, const ProbeCache& cache, const Registry::Options& options) {
  try {
    return examine(file, cache, options);
  } catch (const std::exception& exception) {
    PluginDescription plugin;
    plugin.file = file.string();
    plugin.refused = std::string("can't be probed: ") + exception.what();
    return plugin;
  }
}

std::vector<PluginDescription> find_plugins(const Registry::Options& options) {
  const std::vector<fs::path> files = find_files(options.path);
  std::vector<PluginDescription> plugins(files.size());
  std::vector<std::optional<FileStamp>> stamps(files.size());
  ProbeCache cache(options.cache);
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < files.size(); ++i) {
    stamps[i] = stamp_of(files[i]);
    auto known = stamps[i] ? cache.find(files[i].string(), *stamps[i]) : std::nullopt;
    if (known) {
      plugins[i] = std::move(*known);
    } else {
      unknown.push_back(i);
    }
  }
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < unknown.size(); k = next++) {
      plugins[unknown[k]] = examine_safely(files[unknown[k]], cache, options);
    }
  };
  std::vector<std::thread> workers;
  for (std::size_t i = 1; i < std::min(kProbes, unknown.size()); ++i) workers.emplace_back(work);
  work();
  for (std::thread& worker : workers) worker.join();
  for (const std::size_t i : unknown) {
    if (plugins[i].refused.empty() && stamps[i]) cache.put(plugins[i], *stamps[i]);
  }
  cache.save();
  return plugins;
}

bool equal(const PluginDescription& a, const PluginDescription& b) {
  if (a.name != b.name || a.version != b.version || a.blocks.size() != b.blocks.size()) return false;
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    // As JSON: a NaN among the defaults equals itself there.
    if (a.blocks[i] != b.blocks[i] && to_json(a.blocks[i]) != to_json(b.blocks[i])) return false;
  }
  return true;
}

}  // namespace

struct Registry::State {
  struct Place {
    std::size_t plugin = 0;
    std::size_t block = 0;
  };
  std::vector<PluginDescription> plugins;
  std::vector<std::unique_ptr<Library>> libraries;  // as plugins; null until first used
  std::map<std::string, Place> blocks;

  void take(std::vector<PluginDescription> found) {
    plugins = std::move(found);
    libraries.resize(plugins.size());
    for (std::size_t i = 0; i < plugins.size(); ++i) {
      if (plugins[i].refused.empty()) enter(i);
    }
  }

 private:
  /// Enters a plugin's blocks; refuses it when an earlier one gives any of them.
  void enter(std::size_t index) {
    PluginDescription& plugin = plugins[index];
    for (const BlockDescription& block : plugin.blocks) {
      const auto it = blocks.find(block.id);
      if (it == blocks.end()) continue;
      plugin.refused = fmt::format("gives block '{}', which {} gives already", block.id, plugins[it->second.plugin].file);
      return;
    }
    for (std::size_t k = 0; k < plugin.blocks.size(); ++k) blocks.emplace(plugin.blocks[k].id, Place{index, k});
  }
};

Registry::Registry(Options options) : state_(std::make_shared<State>()) { state_->take(find_plugins(options)); }

Registry Registry::with(std::vector<PluginDescription> plugins) {
  Registry registry{Options{}};
  registry.state_->take(std::move(plugins));
  return registry;
}

Registry::~Registry() = default;
Registry::Registry(Registry&&) noexcept = default;
Registry& Registry::operator=(Registry&&) noexcept = default;

const std::vector<PluginDescription>& Registry::plugins() const { return state_->plugins; }

std::vector<std::string> Registry::ids() const {
  std::vector<std::string> found;
  for (const auto& [id, place] : state_->blocks) found.push_back(id);
  return found;
}

const BlockDescription* Registry::find(const std::string& id) const {
  const auto it = state_->blocks.find(id);
  return it == state_->blocks.end() ? nullptr : &state_->plugins[it->second.plugin].blocks[it->second.block];
}

const PluginDescription* Registry::plugin_of(const std::string& id) const {
  const auto it = state_->blocks.find(id);
  return it == state_->blocks.end() ? nullptr : &state_->plugins[it->second.plugin];
}

tl::expected<bf_block, std::string> Registry::create(const std::string& id, const bf_host& host) {
  const auto it = state_->blocks.find(id);
  if (it == state_->blocks.end()) return tl::unexpected("no plugin gives block '" + id + "'");
  const PluginDescription& plugin = state_->plugins[it->second.plugin];
  std::unique_ptr<Library>& library = state_->libraries[it->second.plugin];
  const auto bad = [&](const std::string& why) {
    return tl::unexpected(fmt::format("plugin '{}' ({}): {}", plugin.name, plugin.file, why));
  };
  if (library == nullptr) {
    auto loaded = Library::load(plugin.file);
    if (!loaded) return bad(loaded.error());
    if (!equal((*loaded)->description(), plugin))
      return bad("describes itself otherwise than when it was probed; was the file replaced?");
    library = std::move(*loaded);
  }
  auto block = library->create(id, host);
  if (!block) return bad(block.error());
  return block;
}

std::shared_ptr<const void> Registry::keep_alive() const { return state_; }

}  // namespace bodeflow
