#pragma once

#include <memory>

#include "execute/remote_end.hpp"
#include "lab/split.hpp"
#include "transport/link.hpp"

namespace bodeflow::lab {

/// The four blocks of the engine's own that stand at the ends of a cut.
const BlockDescription& sample_outlet();  ///< one stream input
const BlockDescription& sample_inlet();   ///< one stream output
const BlockDescription& record_outlet();  ///< one message input, no streams
const BlockDescription& record_inlet();   ///< one message output, fires once a period of the phase

/// A made end: the instance that the executor calls, and what it tells beside its calls.
struct MadeEnd {
  std::unique_ptr<Instance> instance;
  std::shared_ptr<execute::RemoteEnd> end;
};

/// What the run is told when a link gives up.
std::string text_of(const Cut& cut, const transport::Failure& failure);

MadeEnd make_sample_outlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Outlet> outlet);
MadeEnd make_sample_inlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Inlet> inlet);
MadeEnd make_record_outlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Outlet> outlet);
/// `period`: seconds of the phase.
MadeEnd make_record_inlet(const std::string& name, const Cut& cut, const Rate& period, std::unique_ptr<transport::Inlet> inlet);

}  // namespace bodeflow::lab
