#include "live/pool.hpp"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <exception>

namespace bodeflow::tools::live {
namespace {

/// The run comes first where both want a core.
constexpr int kNice = 10;

void yield_to_others() { (void)setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNice); }

}  // namespace

Pool::Pool(std::size_t threads, std::size_t most_waiting) : most_waiting_(most_waiting) {
  while (threads_.size() < threads) threads_.emplace_back([this] { work(); });
}

void Pool::add(std::function<void()> job) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return jobs_.size() < most_waiting_ || over_; });
  jobs_.push_back(std::move(job));
  changed_.notify_all();
}

void Pool::finish() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  for (auto& thread : threads_) thread.join();
  threads_.clear();
}

void Pool::work() {
  yield_to_others();
  while (true) {
    std::function<void()> job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !jobs_.empty() || over_; });
      if (jobs_.empty()) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
    }
    changed_.notify_all();
    try {
      job();
    } catch (const std::exception&) {  // out of memory, say: this request is lost, no more
    }
  }
}

}  // namespace bodeflow::tools::live
