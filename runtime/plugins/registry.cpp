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
  /// Where something stands: an id belongs to one block, effect or base model.
  struct Place {
    std::string kind;
    std::size_t plugin = 0;
    std::size_t index = 0;
  };
  std::vector<PluginDescription> plugins;
  std::map<std::string, Place> places;

  void take(std::vector<PluginDescription> found) {
    plugins = std::move(found);
    libraries_.resize(plugins.size());
    for (std::size_t i = 0; i < plugins.size(); ++i) {
      PluginDescription& plugin = plugins[i];
      if (plugin.refused.empty()) plugin.refused = repeats(plugin);
      if (plugin.refused.empty()) enter(i);
    }
    for (const auto& [id, place] : places) {
      if (place.kind == "effect") descriptors_.add(plugins[place.plugin].effects[place.index]);
      if (place.kind == "base_model") descriptors_.add_base_model(plugins[place.plugin].base_models[place.index]);
    }
  }

  const Place* find(const std::string& kind, const std::string& id) const {
    const auto it = places.find(id);
    return it == places.end() || it->second.kind != kind ? nullptr : &it->second;
  }

  std::vector<std::string> ids(const std::string& kind) const {
    std::vector<std::string> found;
    for (const auto& [id, place] : places) {
      if (place.kind == kind) found.push_back(id);
    }
    return found;
  }

  const std::vector<const void*>& list(const std::string& kind) const override { return descriptors_.list(kind); }

  tl::expected<void, std::string> make(const std::string& kind, const std::string& id, const bf_host& host, void* made) override {
    const Place* place = find(kind, id);
    if (place == nullptr) return tl::unexpected(fmt::format("no plugin gives {} '{}'", kind, id));
    const PluginDescription& plugin = plugins[place->plugin];
    const auto bad = [&](const std::string& why) {
      return tl::unexpected(fmt::format("plugin '{}' ({}): {}", plugin.name, plugin.file, why));
    };
    const auto library = library_of(place->plugin);
    if (!library) return bad(library.error());
    if (auto done = (*library)->create_part(kind, id, host, made); !done) return bad(done.error());
    return {};
  }

 private:
  /// Why a plugin is refused that gives what an earlier one gives, or "".
  std::string repeats(const PluginDescription& plugin) const {
    std::string why;
    const auto look = [&](const auto& given, const char* what) {
      for (const auto& one : given) {
        const auto it = places.find(one.id);
        if (it == places.end() || !why.empty()) continue;
        why = fmt::format("gives {} '{}', which {} gives already", what, one.id, plugins[it->second.plugin].file);
      }
    };
    look(plugin.blocks, "block");
    look(plugin.effects, "effect");
    look(plugin.base_models, "base model");
    return why;
  }

  void enter(std::size_t index) {
    const auto put = [&](const auto& given, const char* kind) {
      for (std::size_t k = 0; k < given.size(); ++k) places.emplace(given[k].id, Place{kind, index, k});
    };
    put(plugins[index].blocks, "block");
    put(plugins[index].effects, "effect");
    put(plugins[index].base_models, "base_model");
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

std::vector<std::string> Registry::ids() const { return state_->ids("block"); }
std::vector<std::string> Registry::effects() const { return state_->ids("effect"); }
std::vector<std::string> Registry::base_models() const { return state_->ids("base_model"); }

const BlockDescription* Registry::find(const std::string& id) const {
  const auto* place = state_->find("block", id);
  return place == nullptr ? nullptr : &state_->plugins[place->plugin].blocks[place->index];
}

const EffectDescription* Registry::find_effect(const std::string& id) const {
  const auto* place = state_->find("effect", id);
  return place == nullptr ? nullptr : &state_->plugins[place->plugin].effects[place->index];
}

const BlockDescription* Registry::find_base_model(const std::string& id) const {
  const auto* place = state_->find("base_model", id);
  return place == nullptr ? nullptr : &state_->plugins[place->plugin].base_models[place->index];
}

const PluginDescription* Registry::plugin_of(const std::string& id) const {
  const auto it = state_->places.find(id);
  return it == state_->places.end() ? nullptr : &state_->plugins[it->second.plugin];
}

tl::expected<bf_block, std::string> Registry::create(const std::string& id, const bf_host& host) {
  bf_block block{};
  if (auto made = state_->make("block", id, host, &block); !made) return tl::unexpected(made.error());
  return block;
}

std::shared_ptr<PartShelf> Registry::parts() const { return state_; }
std::shared_ptr<const void> Registry::keep_alive() const { return state_; }

}  // namespace bodeflow
