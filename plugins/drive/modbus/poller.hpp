#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "session.hpp"

namespace bodeflow::drive::modbus {

/// Counts of a run.
struct PollCounts {
  std::int64_t samples = 0;  ///< calls of `exchange`
  std::int64_t cycles = 0;   ///< that the drive answered
  std::int64_t late = 0;     ///< samples for which the cycle before was not over
  std::int64_t retried = 0;  ///< questions asked again
  double longest_s = 0.0;    ///< of a cycle
  double total_s = 0.0;      ///< of all cycles
};

/// Runs the cycles of a session on a thread of its own, one for each `exchange`, so that a slow drive does not hold up who
/// calls. Without calls there are no cycles: when the caller hangs, the drive's watchdog acts. After a failure, and at the end,
/// the thread stops the drive at once, before anyone asks.
class Poller {
 public:
  explicit Poller(std::unique_ptr<Session> session, Polled first);
  ~Poller();
  Poller(const Poller&) = delete;
  Poller& operator=(const Poller&) = delete;

  /// Starts a cycle with these set points, where none is running (else they wait for it, the newest hold), and fills `newest`
  /// with what the last finished cycle read. Errors: why a cycle failed and how the drive was stopped.
  numerics::Expected<void> exchange(DriveCommand command, const std::vector<double>& set_points, Polled& newest);

  /// Stops the drive and ends the thread; the same answer at every later call.
  const Stopped& stop();

  PollCounts counts() const;

 private:
  struct Wanted {
    DriveCommand command = DriveCommand::quick_stop;
    std::vector<double> set_points;
  };

  void work();
  bool wait_for_work(Wanted& wanted);
  void finish(const numerics::Expected<Polled>& polled, double seconds);

  std::unique_ptr<Session> session_;  // of the thread alone
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Wanted wanted_;
  bool pending_ = false, busy_ = false, ending_ = false;
  Polled newest_;
  PollCounts counts_;
  std::optional<std::string> failure_;
  std::optional<Stopped> stopped_;
  std::thread thread_;
};

}  // namespace bodeflow::drive::modbus
