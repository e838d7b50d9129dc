#pragma once

#include "plugins/description.hpp"

#include <tl/expected.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace bodeflow {

/// The services of one block instance: error text, log, files. Owned by Instance; see instance.hpp.
struct InstanceServices;

/// The plugins found in the search path, probed in child processes (cached), loaded when first used.
class Registry {
 public:
  struct Options {
    std::vector<std::filesystem::path> path;  ///< folders, the earlier wins over none: a duplicate id is refused
    std::filesystem::path cache;              ///< file of the probe cache; empty: none
    std::filesystem::path probe_command;      ///< our own executable, called as `probe_command probe-plugin FILE`
  };

  explicit Registry(Options options);
  ~Registry();
  Registry(Registry&&) noexcept;
  Registry& operator=(Registry&&) noexcept;

  /// Every plugin file that was found, usable or refused (with the reason).
  const std::vector<PluginDescription>& plugins() const;

  /// Block ids of all usable plugins, sorted.
  std::vector<std::string> ids() const;

  /// The description of a block, or nullptr. Stable for the life of the registry.
  const BlockDescription* find(const std::string& id) const;
  const PluginDescription* plugin_of(const std::string& id) const;

  /// Makes a block (loads its plugin if needed). The library outlives the block. Error: why not, with the plugin's name.
  tl::expected<bf_block, std::string> create(const std::string& id, const bf_host& host);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Where plugins are looked for: BODEFLOW_PLUGIN_PATH (colon separated), beside the executable (../plugins,
/// ../lib/bodeflow/plugins), ~/.local/lib/bodeflow/plugins.
std::vector<std::filesystem::path> default_plugin_path();

}  // namespace bodeflow
