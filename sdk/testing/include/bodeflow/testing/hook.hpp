#pragma once

#include <cstdint>

/// What a thread did between `begin` and `end`, as bodeflow::testing_hook counts it. The functions are absent (null) in a
/// program that does not link the hook.
extern "C" {

struct bodeflow_hook_counts {
  std::uint64_t allocations;  ///< malloc and its kin, free
  std::uint64_t locks;        ///< of mutexes, conditions, semaphores
  std::uint64_t calls;        ///< that open, read, write or sleep
  const char* first;          ///< name of the first function called, or null
};

void bodeflow_hook_begin() __attribute__((weak));
bodeflow_hook_counts bodeflow_hook_end() __attribute__((weak));
/// Counts on (1) or not (0) from here; returns what it was.
int bodeflow_hook_pause(int armed) __attribute__((weak));
}
