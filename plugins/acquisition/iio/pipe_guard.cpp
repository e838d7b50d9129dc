#include "pipe_guard.hpp"

#include <pthread.h>
#include <time.h>

namespace bodeflow::acquisition {
namespace {

sigset_t pipe_signal() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGPIPE);
  return set;
}

bool is_pending() {
  sigset_t pending;
  return sigpending(&pending) == 0 && sigismember(&pending, SIGPIPE) == 1;
}

}  // namespace

PipeGuard::PipeGuard() : was_pending_(is_pending()) {
  const sigset_t set = pipe_signal();
  sigset_t before;
  sigemptyset(&before);
  pthread_sigmask(SIG_BLOCK, &set, &before);
  was_blocked_ = sigismember(&before, SIGPIPE) == 1;
}

PipeGuard::~PipeGuard() {
  const sigset_t set = pipe_signal();
  const timespec at_once{0, 0};
  if (!was_pending_ && is_pending()) sigtimedwait(&set, nullptr, &at_once);
  if (!was_blocked_) pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace bodeflow::acquisition
