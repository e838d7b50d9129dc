#pragma once

#include <functional>
#include <string>
#include <thread>

#include "graph/graph.hpp"

namespace bodeflow::execute {

using Warn = std::function<void(const std::string&)>;

/// The memory of the process, locked and in place while this lives: no page fault stops a compute thread.
class LockedMemory {
 public:
  /// Locks nothing without RunSettings::priority. What the system does not permit is told to `warn`.
  LockedMemory(const graph::RunSettings& run, const Warn& warn);
  ~LockedMemory();
  LockedMemory(const LockedMemory&) = delete;
  LockedMemory& operator=(const LockedMemory&) = delete;

 private:
  bool locked_ = false;
};

/// The cores of the machine, kept from sleeping while this lives: waking them takes up to some 100 us.
class AwakeCores {
 public:
  /// Changes nothing without RunSettings::priority. What the system does not permit is told to `warn`.
  AwakeCores(const graph::RunSettings& run, const Warn& warn);
  ~AwakeCores();
  AwakeCores(const AwakeCores&) = delete;
  AwakeCores& operator=(const AwakeCores&) = delete;

 private:
  int device_ = -1;
};

/// Wakes the calling thread at its times: the kernel lets timers of threads without a real-time priority end 50 us late.
void wake_in_time();

/// Gives compute threads the priority and the cores of the run settings; says each of the two once where it is not permitted.
class Scheduling {
 public:
  Scheduling(const graph::RunSettings& run, Warn warn) : run_(run), warn_(std::move(warn)) {}

  /// The next compute thread.
  void apply(std::thread::native_handle_type thread);

 private:
  void say(bool& warned, const std::string& text) const;

  const graph::RunSettings& run_;
  Warn warn_;
  std::size_t next_ = 0;
  bool warned_priority_ = false, warned_core_ = false;
};

}  // namespace bodeflow::execute
