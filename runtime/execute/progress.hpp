#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "execute/partition.hpp"

namespace bodeflow::execute {

/// How far the run is: the slowest thread counts.
Progress progress_of(const Run& run);

/// Calls Options::progress a few times a second, and once at the end, from a thread of its own; no thread where it is not set.
class Reporter {
 public:
  explicit Reporter(const Run& run);
  ~Reporter();
  Reporter(const Reporter&) = delete;
  Reporter& operator=(const Reporter&) = delete;

 private:
  void work();

  const Run& run_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace bodeflow::execute
