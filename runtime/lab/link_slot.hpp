#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "transport/link.hpp"

namespace bodeflow::lab {

/// The link of an end, which another thread may take out and put another in place of while the block's thread uses it.
template <class Link>
class LinkSlot {
 public:
  explicit LinkSlot(std::unique_ptr<Link> link) : link_(std::move(link)) {}

  /// What `use_link(link, go_on)` returns, a tl::expected with a transport::Failure. Where the link is taken out meanwhile, waits
  /// for the next one and calls again; where its tolerance ends in a pause, calls again.
  template <class Use>
  auto use(const transport::GoOn& go_on, Use use_link) {
    std::unique_lock lock(mutex_);
    while (true) {
      while (leaving_ || !link_) {
        if (!go_on()) return decltype(use_link(*link_, go_on))(tl::unexpected(stopped()));
        changed_.wait_for(lock, kLook);
      }
      const unsigned pauses = pauses_;
      auto done = use_link(*link_, [&] { return !leaving_ && go_on(); });
      const bool paused = pauses_ % 2 == 1 || pauses_ != pauses;
      if (!done && (leaving_ || (paused && done.error().kind == transport::Failure::Kind::tolerance))) continue;
      return done;
    }
  }

  /// [another thread] From now on, or no more, others wait for a lost host: nothing need come within the tolerance.
  void pause(bool yes) {
    if ((pauses_ % 2 == 1) != yes) ++pauses_;
  }

  /// [another thread] Takes the link out, once it is not in use; `look(link)` sees it before, or null where it is out already. It
  /// lives on, unused, as long as this does: others may look at its state.
  template <class Look>
  auto take_out(Look look) {
    leaving_ = true;
    const std::lock_guard lock(mutex_);
    leaving_ = false;
    if (!link_) return look(static_cast<Link*>(nullptr));
    used_.push_back(std::move(link_));
    return look(used_.back().get());
  }

  /// [another thread] `look(link)` sees the new link before the block does.
  template <class Look>
  auto put_in(std::unique_ptr<Link> link, Look look) {
    const std::lock_guard lock(mutex_);
    link_ = std::move(link);
    changed_.notify_all();
    return look(*link_);
  }

 private:
  static constexpr std::chrono::milliseconds kLook{20};
  static transport::Failure stopped() { return {transport::Failure::Kind::stopped, "stopped"}; }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> leaving_{false};
  std::atomic<unsigned> pauses_{0};  ///< begun and ended; odd: in one
  std::unique_ptr<Link> link_;
  std::vector<std::unique_ptr<Link>> used_;
};

}  // namespace bodeflow::lab
