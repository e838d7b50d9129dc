#pragma once

namespace bodeflow {

/// From now on a thread that crashes says in which block, on standard error, before the process dies as it would have.
void tell_crashes();

/// While it lives, this thread is known to work for blocks. Neither making it nor what it does in a crash takes memory or a lock.
class AtWork {
 public:
  struct Block {
    const char* name = nullptr;  ///< null: in none
    const char* type = nullptr;
  };
  using Where = Block (*)(const void* what);

  /// `where(what)` is asked when the thread crashes.
  AtWork(Where where, const void* what);
  ~AtWork();
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

  static Block block();

 private:
  Where where_;
  const void* what_;
  const AtWork* before_;
};

}  // namespace bodeflow
