#pragma once

#include <memory>
#include <string>

#include "execute/block.hpp"
#include "lab/remote_blocks.hpp"

namespace bodeflow::lab {

/// A block of the engine's own at the end of a cut: a bf_block whose calls come here.
class End : public execute::RemoteEnd {
 public:
  /// Makes the instance that calls `end`.
  static MadeEnd wrap(const std::string& name, const BlockDescription& type, std::shared_ptr<End> end);

 protected:
  /// One call of process. Error: why the run ends.
  virtual tl::expected<void, std::string> process(execute::BlockRun& block, bf_process& call) = 0;
  virtual tl::expected<void, std::string> finish(execute::BlockRun& block) = 0;

 private:
  struct Functions;
};

}  // namespace bodeflow::lab
