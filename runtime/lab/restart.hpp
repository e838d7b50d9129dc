#pragma once

#include "lab/host_parts.hpp"

namespace bodeflow::lab {

/// The phase that runs, as its launcher knows it.
struct RunningPhase {
  const graph::Phase& phase;
  std::size_t index = 0;  ///< in the graph
  int repeat = 0;
  const plan::Facts& facts;
  const std::vector<execute::InitialRecord>& initial;
  std::chrono::steady_clock::time_point started;
};

/// Sends `initial` and lets a part run.
tl::expected<void, std::string> begin_phase(HostPart& part, const std::vector<execute::InitialRecord>& initial,
                                            std::uint64_t seed);

/// Starts the parts of lost hosts again while the other hosts wait for them.
class Restart {
 public:
  /// Called of each part that is found lost, before it is replaced. Error: it is not to be.
  using OnLost = std::function<tl::expected<void, Ended>(HostPart&, const std::string& why)>;

  Restart(HostParts& hosts, const RunningPhase& running, OnLost on_lost)
      : hosts_(hosts), running_(running), on_lost_(std::move(on_lost)) {}

  /// Once: starts `lost` again, with all other parts that are lost meanwhile: the seconds of the phase at which they go on. That
  /// is the first chunk that neither any other host has sent samples of to them, nor has got samples of from them; of a phase
  /// that is paced, at the earliest the chunk whose time it is. Error: why the run can't go on.
  tl::expected<double, Ended> run(HostPart& lost, const std::string& why);
  /// The hosts whose parts it has started.
  const std::set<std::string>& restarted() const { return away_; }

 private:
  tl::expected<void, Ended> lose(HostPart& part, const std::string& why);
  tl::expected<double, Ended> start();
  tl::expected<std::int64_t, Ended> leave();
  tl::expected<void, Ended> make_blocks(HostPart& part);
  tl::expected<void, Ended> connect();
  std::int64_t begin_of(std::int64_t least) const;
  bool is_away(const HostPart& part) const { return away_.contains(part.name()); }

  HostParts& hosts_;
  const RunningPhase& running_;
  OnLost on_lost_;
  std::set<std::string> away_;
  std::int64_t chunk_ = 1;  ///< periods of the phase
  double period_s_ = 0.0;
};

}  // namespace bodeflow::lab
