#include "execute/worker.hpp"

#include <utility>

#include "execute/block.hpp"

namespace bodeflow::execute {

std::int64_t Worker::hand(Entry entry) {
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(entry));
  }
  work_.raise();
  return ++handed_;
}

bool Worker::wait(std::int64_t job, int waiting, Lane& lane) {
  return lane.wait(control_, answers_, Lane::Wait::answer, waiting, block_.index, [&] { return done(job); });
}

void Worker::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  work_.raise();
}

void Worker::run() {
  while (!control_.stopping()) {
    const std::uint32_t epoch = work_.epoch();
    Entry entry;
    bool found = false, closed = false;
    {
      const std::lock_guard lock(mutex_);
      closed = closed_;
      if (!queue_.empty()) {
        entry = std::move(queue_.front());
        queue_.pop_front();
        found = true;
      }
    }
    if (found) {
      if (!take_alone(block_, std::move(entry), lane_)) return;
      done_.fetch_add(1, std::memory_order_acq_rel);
      answers_.raise();
    } else if (closed) {
      return;
    } else {
      work_.wait(epoch);
    }
  }
}

}  // namespace bodeflow::execute
