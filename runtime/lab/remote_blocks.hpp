#pragma once

#include <functional>
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

/// Samples that are missing in a stream because the host that made them was lost.
struct Gap {
  std::uint64_t first = 0, count = 0;  ///< samples of the stream
  std::uint32_t epoch = 0;             ///< of the part that goes on behind
  Rate rate;                           ///< of the stream
};

/// A new link in place of a lost one: of the kind that the end had.
struct NewLink {
  std::unique_ptr<transport::Outlet> outlet;
  std::unique_ptr<transport::Inlet> inlet;
  std::uint32_t epoch = 0;
};

/// What is done to the end of a stream where a lost host is started again. From other threads than the block's.
class StreamEnd {
 public:
  virtual ~StreamEnd() = default;
  /// Before the run, of a part that goes on for a lost one: its first sample is the stream's sample `sample`.
  virtual void begin_at(std::uint64_t sample) = 0;
  /// Called in the block's thread when a gap is known.
  virtual void on_gap(std::function<void(const Gap&)>) {}
  /// Lets go of the link to a lost host, if it has not yet; the block waits for the next one. The sample from which on the stream
  /// may go on. Error: it can't.
  virtual tl::expected<std::uint64_t, std::string> leave() = 0;
  /// Goes on with another link, over which the stream goes on at `sample`.
  virtual tl::expected<void, transport::Failure> rejoin(NewLink link, std::uint64_t sample, const transport::GoOn& go_on) = 0;
  /// Whether the host waits for a lost one: no tolerance ends meanwhile.
  virtual void pause(bool yes) = 0;
};

/// A made end: the instance that the executor calls, and what it tells beside its calls.
struct MadeEnd {
  std::unique_ptr<Instance> instance;
  std::shared_ptr<execute::RemoteEnd> end;
  std::shared_ptr<StreamEnd> stream;  ///< null: of records
};

/// What the run is told when a link gives up.
std::string text_of(const Cut& cut, const transport::Failure& failure);

MadeEnd make_sample_outlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Outlet> outlet);
MadeEnd make_sample_inlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Inlet> inlet);
MadeEnd make_record_outlet(const std::string& name, const Cut& cut, std::unique_ptr<transport::Outlet> outlet);
/// `period`: seconds of the phase.
MadeEnd make_record_inlet(const std::string& name, const Cut& cut, const Rate& period, std::unique_ptr<transport::Inlet> inlet);

}  // namespace bodeflow::lab
