#include "transport/leave.hpp"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>

namespace bodeflow::transport {
namespace {

constexpr std::chrono::seconds kPatience{2};

void end_at_once(int status, void* /*nothing*/) {
  std::fflush(nullptr);
  _exit(status);
}

struct Farewell {
  std::mutex mutex;
  std::condition_variable gone;
  bool done = false;
};

}  // namespace

void leave(std::function<void()> work) {
  auto farewell = std::make_shared<Farewell>();
  std::thread([farewell, work = std::move(work)]() mutable {
    work();
    work = nullptr;
    const std::lock_guard lock(farewell->mutex);
    farewell->done = true;
    farewell->gone.notify_all();
  }).detach();
  std::unique_lock lock(farewell->mutex);
  if (!farewell->gone.wait_for(lock, kPatience, [&] { return farewell->done; })) {
    static std::once_flag once;
    std::call_once(once, [] { on_exit(end_at_once, nullptr); });
  }
}

}  // namespace bodeflow::transport
