#include "execute/crew.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "plugins/crash.hpp"

namespace bodeflow::execute {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// How often the caller's wish to stop is looked at while threads wait or compute.
constexpr double kPoll_s = 0.1;
/// What threads that only wait get to leave, once the run was ended.
constexpr double kGrace_s = 1.0;

/// Where a thread of a run stands, for a word about its crash.
struct Post {
  const Run* run;
  const Lane* lane;

  static AtWork::Block block(const void* self) {
    const auto& post = *static_cast<const Post*>(self);
    const int index = post.lane->doing().block;
    if (index < 0) return {};
    const graph::Block& block = post.run->phase->blocks[static_cast<std::size_t>(index)];
    return {block.name.c_str(), block.type->id.c_str()};
  }
};

void guarded(Run& run, const std::function<void()>& body) noexcept {
  try {
    body();
  } catch (const std::exception& e) {
    run.control.fail(-1, e.what());
  } catch (...) {
    run.control.fail(-1, "an exception that is not derived from std::exception");
  }
}

}  // namespace

std::thread::native_handle_type Crew::start(Lane& lane, std::string name, std::function<void()> body) {
  members_.reserve(members_.size() + 1);
  std::thread thread([run = run_, state = state_, &lane, body = std::move(body)] {
    const Post post{run.get(), &lane};
    const AtWork here(Post::block, &post);
    guarded(*run, body);
    const std::lock_guard lock(state->mutex);
    lane.over();
    state->changed.notify_all();
  });
  members_.push_back({std::move(thread), &lane, std::move(name)});
  return members_.back().thread.native_handle();
}

bool Crew::all_over(std::size_t first) const {
  return std::all_of(members_.begin() + static_cast<std::ptrdiff_t>(first), members_.end(),
                     [](const Member& member) { return member.lane->doing().over; });
}

bool Crew::watch(std::size_t first) {
  const double patience = run_->options.watchdog_s;
  const Seconds poll(patience > 0.0 ? std::min(kPoll_s, patience / 4) : kPoll_s);
  std::uint64_t calls = calls_of(members_);
  auto since = Clock::now();
  double limit = patience;
  std::unique_lock lock(state_->mutex);
  while (!state_->changed.wait_for(lock, poll, [&] { return all_over(first); })) {
    run_->stop_wanted();
    run_->tell_violations();
    const std::uint64_t now = calls_of(members_);
    const double still = Seconds(Clock::now() - since).count();
    const bool finishing = !run_->control.stopping() && in_finish(members_);
    if (now != calls) {
      calls = now;
      since = Clock::now();
    } else if (patience > 0.0 && still >= limit * (finishing ? kFinishing : 1.0)) {
      std::string report = stall_report(*run_, members_, still);
      if (run_->control.stopping()) {
        hang_ = std::move(report);
        return false;
      }
      run_->control.fail(-1, std::move(report));
      since = Clock::now();
      limit = std::min(patience, kGrace_s);
    }
  }
  return true;
}

std::vector<int> Crew::disband() {
  std::vector<int> hanging;
  for (Member& member : members_) {
    const Lane::Doing doing = member.lane->doing();
    if (doing.over) {
      member.thread.join();
    } else {
      hanging.push_back(doing.block);
      member.thread.detach();
    }
  }
  members_.clear();
  return hanging;
}

}  // namespace bodeflow::execute
