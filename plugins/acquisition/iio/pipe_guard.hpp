#pragma once

#include <signal.h>

namespace bodeflow::acquisition {

/// While it lives, writing to a connection that the other side closed is an error alone, no signal that ends the process: libiio
/// 0.24 writes to its sockets without asking for that. For the calling thread; a signal that came is taken away.
class PipeGuard {
 public:
  PipeGuard();
  ~PipeGuard();
  PipeGuard(const PipeGuard&) = delete;
  PipeGuard& operator=(const PipeGuard&) = delete;

 private:
  bool was_pending_ = false, was_blocked_ = false;
};

}  // namespace bodeflow::acquisition
