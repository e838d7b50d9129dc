#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "plugins/description.hpp"
#include "plugins/part_shelf.hpp"

namespace bodeflow {

/// The plugins found in the search path, probed in child processes (cached), loaded when first used.
class Registry {
 public:
  struct Options {
    std::vector<std::filesystem::path>
        path;                             ///< folders with `*.so`, or plugin files; of two with the same id the later is refused
    std::filesystem::path cache;          ///< file of the probe cache; empty: none
    std::filesystem::path probe_command;  ///< our own executable, called as `probe_command probe-plugin FILE`
    double probe_timeout_s = 10.0;        ///< a plugin that takes longer to describe itself is refused
  };

  /// Finds and probes; never throws because of a plugin, an absent folder or the cache.
  explicit Registry(Options options);
  /// A registry of given descriptions, without files: graphs can be checked against it, blocks can't be made.
  static Registry with(std::vector<PluginDescription> plugins);
  ~Registry();
  Registry(Registry&&) noexcept;
  Registry& operator=(Registry&&) noexcept;

  /// Every plugin file that was found, usable or refused (with the reason).
  const std::vector<PluginDescription>& plugins() const;

  /// Block ids of all usable plugins, sorted.
  std::vector<std::string> ids() const;

  /// The description of a block, or nullptr. Stable for the life of the registry.
  const BlockDescription* find(const std::string& id) const;

  /// The same for effects and base models.
  std::vector<std::string> effects() const;
  std::vector<std::string> base_models() const;
  const EffectDescription* find_effect(const std::string& id) const;
  const BlockDescription* find_base_model(const std::string& id) const;

  /// The plugin that gives a block, an effect or a base model, or nullptr.
  const PluginDescription* plugin_of(const std::string& id) const;
  /// What hosts of blocks offer; lives beyond the registry.
  std::shared_ptr<PartShelf> parts() const;

  /// Makes a block (loads its plugin if needed). The library outlives the block. Error: why not, with the plugin's name.
  /// [control] `host` outlives the block.
  tl::expected<bf_block, std::string> create(const std::string& id, const bf_host& host);

  /// Keeps the libraries and descriptions in memory, also beyond the registry's own life.
  std::shared_ptr<const void> keep_alive() const;

 private:
  struct State;
  std::shared_ptr<State> state_;  // shared with the instances, see keep_alive
};

/// Where plugins are looked for: BODEFLOW_PLUGIN_PATH (colon separated), beside the executable (../plugins,
/// ../lib/bodeflow/plugins), ~/.local/lib/bodeflow/plugins.
std::vector<std::filesystem::path> default_plugin_path();

}  // namespace bodeflow
