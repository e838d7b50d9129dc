#include "poller.hpp"

#include <algorithm>
#include <chrono>

namespace bodeflow::drive::modbus {

using numerics::Expected;
using numerics::refused;

Poller::Poller(std::unique_ptr<Session> session, Polled first) : session_(std::move(session)), newest_(std::move(first)) {
  thread_ = std::thread([this] { work(); });
}

Poller::~Poller() { stop(); }

Expected<void> Poller::exchange(DriveCommand command, const std::vector<double>& set_points, Polled& newest) {
  {
    const std::lock_guard lock(mutex_);
    if (failure_) return refused(*failure_ + (stopped_ ? "; " + stopped_->text : "; the drive is being stopped"));
    ++counts_.samples;
    if (pending_ || busy_) ++counts_.late;
    wanted_.command = command;
    wanted_.set_points = set_points;
    pending_ = true;
    newest = newest_;
  }
  wake_.notify_one();
  return {};
}

const Stopped& Poller::stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
  return *stopped_;
}

PollCounts Poller::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

bool Poller::wait_for_work(Wanted& wanted) {
  std::unique_lock lock(mutex_);
  wake_.wait(lock, [this] { return pending_ || ending_; });
  if (ending_) return false;
  std::swap(wanted, wanted_);
  pending_ = false;
  busy_ = true;
  return true;
}

void Poller::finish(const Expected<Polled>& polled, double seconds) {
  const std::lock_guard lock(mutex_);
  busy_ = false;
  counts_.retried = session_->retried();
  if (!polled) {
    failure_ = polled.error().text;
    return;
  }
  newest_ = *polled;
  ++counts_.cycles;
  counts_.total_s += seconds;
  counts_.longest_s = std::max(counts_.longest_s, seconds);
}

void Poller::work() {
  using Clock = std::chrono::steady_clock;
  Wanted wanted;
  bool good = true;
  while (good && wait_for_work(wanted)) {
    const auto begun = Clock::now();
    const auto polled = session_->cycle(wanted.command, wanted.set_points);
    finish(polled, std::chrono::duration<double>(Clock::now() - begun).count());
    good = polled.has_value();
  }
  const Stopped stopped = session_->stop();
  const std::lock_guard lock(mutex_);
  stopped_ = stopped;
}

}  // namespace bodeflow::drive::modbus
