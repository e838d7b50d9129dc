#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "plugins/description.hpp"

namespace bodeflow {

/// A plugin in memory: its code has run. Stays loaded as long as the object lives.
class Library {
 public:
  /// Loads the file, checks its symbol and ABI, and reads all descriptors. Error: why not, without the file's name.
  static tl::expected<std::unique_ptr<Library>, std::string> load(const std::filesystem::path& file);
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// name, version, build, blocks, effects and base models; the other fields are empty.
  const PluginDescription& description() const;

  /// Makes a block. `host` outlives it. Error: the plugin's own words.
  tl::expected<bf_block, std::string> create(const std::string& id, const bf_host& host) const;
  /// Fills `made` with an effect (kind "effect": a bf_effect) or a base model ("base_model": a bf_base_model). Error: the
  /// plugin's own words. Any thread.
  tl::expected<void, std::string> create_part(const std::string& kind, const std::string& id, const bf_host& host,
                                              void* made) const;

 private:
  Library();
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bodeflow
