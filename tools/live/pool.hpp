#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace bodeflow::tools::live {

/// A few threads of low priority for jobs, of which a bounded number waits: who brings one more waits as well.
class Pool {
 public:
  Pool(std::size_t threads, std::size_t most_waiting);
  ~Pool() { finish(); }
  void add(std::function<void()> job);
  /// Does what waits, then ends the threads.
  void finish();

 private:
  void work();

  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  bool over_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace bodeflow::tools::live
