#include "plugins/registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include "plugins/cache.hpp"
#include "plugins/description_json.hpp"
#include "plugins/elf_note.hpp"
#include "plugins/file_bytes.hpp"
#include "plugins/library.hpp"
#include "plugins/part_descriptors.hpp"
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

/// What a plugin says of itself, without the file. As JSON: a NaN among the defaults equals itself there.
nlohmann::ordered_json words_of(PluginDescription plugin) {
  plugin.file.clear();
  plugin.sha256.clear();
  plugin.build.clear();
  plugin.refused.clear();
  return to_json(plugin);
}

}  // namespace

struct Registry::State : PartShelf {
  struct Place {
    std::size_t plugin = 0;
    std::size_t index = 0;
  };
  using Places = std::map<std::string, Place>;
  std::vector<PluginDescription> plugins;
  Places blocks, effects, base_models;

  void take(std::vector<PluginDescription> found) {
    plugins = std::move(found);
    libraries_.resize(plugins.size());
    for (std::size_t i = 0; i < plugins.size(); ++i) {
      if (plugins[i].refused.empty()) enter(i);
    }
    for (const auto& [id, place] : effects) descriptors_.add(plugins[place.plugin].effects[place.index]);
    for (const auto& [id, place] : base_models) descriptors_.add_base_model(plugins[place.plugin].base_models[place.index]);
  }

  const std::vector<const void*>& list(const std::string& kind) const override { return descriptors_.list(kind); }

  tl::expected<void, std::string> make(const std::string& kind, const std::string& id, const bf_host& host, void* made) override {
    const Places& places = kind == "block" ? blocks : kind == "effect" ? effects : base_models;
    const auto it = places.find(id);
    if (it == places.end() || (kind != "block" && kind != "effect" && kind != "base_model")) {
      return tl::unexpected(fmt::format("no plugin gives {} '{}'", kind == "base_model" ? "base model" : kind, id));
    }
    const PluginDescription& plugin = plugins[it->second.plugin];
    const auto bad = [&](const std::string& why) {
      return tl::unexpected(fmt::format("plugin '{}' ({}): {}", plugin.name, plugin.file, why));
    };
    const auto library = library_of(it->second.plugin);
    if (!library) return bad(library.error());
    if (auto done = (*library)->create_part(kind, id, host, made); !done) return bad(done.error());
    return {};
  }

 private:
  /// Enters what a plugin gives; refuses it when an earlier one gives any of it.
  void enter(std::size_t index) {
    PluginDescription& plugin = plugins[index];
    const bool free = is_free(plugin, plugin.blocks, blocks, "block") && is_free(plugin, plugin.effects, effects, "effect") &&
                      is_free(plugin, plugin.base_models, base_models, "base model");
    if (!free) return;
    for (std::size_t k = 0; k < plugin.blocks.size(); ++k) blocks.emplace(plugin.blocks[k].id, Place{index, k});
    for (std::size_t k = 0; k < plugin.effects.size(); ++k) effects.emplace(plugin.effects[k].id, Place{index, k});
    for (std::size_t k = 0; k < plugin.base_models.size(); ++k) base_models.emplace(plugin.base_models[k].id, Place{index, k});
  }

  template <class Description>
  bool is_free(PluginDescription& plugin, const std::vector<Description>& given, const Places& taken, const char* what) const {
    for (const Description& one : given) {
      const auto it = taken.find(one.id);
      if (it == taken.end()) continue;
      plugin.refused = fmt::format("gives {} '{}', which {} gives already", what, one.id, plugins[it->second.plugin].file);
      return false;
    }
    return true;
  }

  tl::expected<const Library*, std::string> library_of(std::size_t index) {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Library>& library = libraries_[index];
    if (library == nullptr) {
      auto loaded = Library::load(plugins[index].file);
      if (!loaded) return tl::unexpected(loaded.error());
      if (words_of((*loaded)->description()) != words_of(plugins[index]))
        return tl::unexpected(std::string("describes itself otherwise than when it was probed; was the file replaced?"));
      library = std::move(*loaded);
    }
    return library.get();
  }

  std::mutex mutex_;                                 // of `libraries_`: parts are made on any thread
  std::vector<std::unique_ptr<Library>> libraries_;  // as plugins; null until first used
  PartDescriptors descriptors_;
};

namespace {

template <class Places>
std::vector<std::string> ids_of(const Places& places) {
  std::vector<std::string> found;
  for (const auto& [id, place] : places) found.push_back(id);
  return found;
}

}  // namespace

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

std::vector<std::string> Registry::ids() const { return ids_of(state_->blocks); }
std::vector<std::string> Registry::effects() const { return ids_of(state_->effects); }
std::vector<std::string> Registry::base_models() const { return ids_of(state_->base_models); }

const BlockDescription* Registry::find(const std::string& id) const {
  const auto it = state_->blocks.find(id);
  return it == state_->blocks.end() ? nullptr : &state_->plugins[it->second.plugin].blocks[it->second.index];
}

const PluginDescription* Registry::plugin_of(const std::string& id) const {
  const auto it = state_->blocks.find(id);
  return it == state_->blocks.end() ? nullptr : &state_->plugins[it->second.plugin];
}

const EffectDescription* Registry::find_effect(const std::string& id, const PluginDescription** plugin) const {
  const auto it = state_->effects.find(id);
  if (it == state_->effects.end()) return nullptr;
  const PluginDescription& owner = state_->plugins[it->second.plugin];
  if (plugin != nullptr) *plugin = &owner;
  return &owner.effects[it->second.index];
}

const BlockDescription* Registry::find_base_model(const std::string& id, const PluginDescription** plugin) const {
  const auto it = state_->base_models.find(id);
  if (it == state_->base_models.end()) return nullptr;
  const PluginDescription& owner = state_->plugins[it->second.plugin];
  if (plugin != nullptr) *plugin = &owner;
  return &owner.base_models[it->second.index];
}

tl::expected<bf_block, std::string> Registry::create(const std::string& id, const bf_host& host) {
  bf_block block{};
  if (auto made = state_->make("block", id, host, &block); !made) return tl::unexpected(made.error());
  return block;
}

std::shared_ptr<PartShelf> Registry::parts() const { return state_; }
std::shared_ptr<const void> Registry::keep_alive() const { return state_; }

}  // namespace bodeflow
