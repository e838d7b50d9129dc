#pragma once

#include <bodeflow/abi.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace bodeflow {

/// The effects and base models of all plugins, for the hosts of blocks. Any thread.
class PartShelf {
 public:
  virtual ~PartShelf() = default;

  /// The C descriptors of a kind, ordered by id; they live as long as the shelf. Nothing for a kind that has none.
  virtual const std::vector<const void*>& list(const std::string& kind) const = 0;
  /// Fills `made` with a new part; its plugin is loaded where it is not yet, and stays as long as the shelf. Error: why not, with
  /// the plugin's name.
  virtual tl::expected<void, std::string> make(const std::string& kind, const std::string& id, const bf_host& host,
                                               void* made) = 0;
};

}  // namespace bodeflow
