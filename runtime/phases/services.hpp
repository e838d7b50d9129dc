#pragma once

#include <functional>
#include <memory>

#include "plugins/instance.hpp"
#include "record/run_directory.hpp"

namespace bodeflow::phases {

/// The host services of a run's blocks. Blocks are made before there is a run directory: what they log and which files they
/// read until then is kept, and handed over by `attach`. Without a directory (a check) no block may write a file.
class Services {
 public:
  /// `echo` sees every message of a block as it comes.
  using Echo = std::function<void(const std::string& block, int level, const std::string& text)>;
  explicit Services(Echo echo = {});

  std::shared_ptr<const HostServices> host() const { return host_; }
  void attach(record::RunDirectory& directory);
  /// Gives blocks another service by its id; it outlives them. Before any block is activated.
  void provide(std::string id, const void* service);

 private:
  struct State;
  std::shared_ptr<State> state_;
  std::shared_ptr<HostServices> host_;
};

}  // namespace bodeflow::phases
