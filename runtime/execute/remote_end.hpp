#pragma once

#include "execute/inbox.hpp"
#include "execute/lane.hpp"
#include "plugins/instance.hpp"

namespace bodeflow::execute {

struct BlockRun;

/// What the executor tells a block of the engine's own that is one end of a link to another process. All calls come from the
/// thread that runs the block. False: the run is to end, Control knows why.
class RemoteEnd {
 public:
  virtual ~RemoteEnd() = default;
  /// A block with a stream input: its stream has ended, all of it was given.
  virtual bool ended(BlockRun&, Lane&) { return true; }
  /// A block without streams: nothing more comes that takes effect before `horizon`.
  virtual bool reached(BlockRun&, const Horizon&, Lane&) { return true; }
  /// [any thread] A block that gives records: whether no more come before the blocks finish. Its streams' end does not tell.
  virtual bool silent() const { return true; }
  /// At the end of the run, before any block finishes: blocks without streams have taken what was left.
  virtual bool rested(BlockRun&, Lane&) { return true; }
};

/// Gives a record that another process sent on to who takes it from output `port` of `block`: in effect from `effect` on, made
/// at `made_s`. "" or what is wrong with the record.
std::string forward(BlockRun& block, std::uint32_t port, const SharedRecord& record, const Time& effect, double made_s);

/// Whether the run goes on, for waits in a remote end; keeps the watchdog quiet.
bool goes_on(BlockRun& block, Lane& lane);

/// The lane of the thread that runs `block` while streams flow, and that of the last thread.
Lane& lane_of(BlockRun& block);
Lane& last_lane_of(BlockRun& block);

}  // namespace bodeflow::execute
