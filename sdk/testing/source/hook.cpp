// Counts calls of the C library that a real-time path must not make, by standing before them: a program that links this file
// exports these names, so the plugins that it loads call them. A sanitizer stands in the same place; under one nothing is
// counted.
#include <bodeflow/testing/hook.hpp>

#include "sanitized.hpp"

#if !defined(BODEFLOW_SANITIZED)

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/types.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <ctime>

namespace {

thread_local bool t_armed = false;
thread_local bodeflow_hook_counts t_counts{};

void count(std::uint64_t bodeflow_hook_counts::*kind, const char* name) {
  if (!t_armed) return;
  ++(t_counts.*kind);
  if (t_counts.first == nullptr) t_counts.first = name;
}

template <class Function>
Function next(const char* name) {
  const bool armed = t_armed;
  t_armed = false;
  const auto found = reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
  t_armed = armed;
  return found;
}

constexpr auto kAllocation = &bodeflow_hook_counts::allocations;
constexpr auto kLock = &bodeflow_hook_counts::locks;
constexpr auto kCall = &bodeflow_hook_counts::calls;

}  // namespace

#define BODEFLOW_HOOK __attribute__((visibility("default"), used))

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

BODEFLOW_HOOK void bodeflow_hook_begin() {
  t_counts = {};
  t_armed = true;
}
BODEFLOW_HOOK bodeflow_hook_counts bodeflow_hook_end() {
  t_armed = false;
  return t_counts;
}
BODEFLOW_HOOK int bodeflow_hook_pause(int armed) {
  const int was = t_armed ? 1 : 0;
  t_armed = armed != 0;
  return was;
}

BODEFLOW_HOOK void* malloc(std::size_t size) noexcept { return count(kAllocation, "malloc"), __libc_malloc(size); }
BODEFLOW_HOOK void* calloc(std::size_t n, std::size_t size) noexcept {
  return count(kAllocation, "calloc"), __libc_calloc(n, size);
}
BODEFLOW_HOOK void* realloc(void* block, std::size_t size) noexcept {
  return count(kAllocation, "realloc"), __libc_realloc(block, size);
}
BODEFLOW_HOOK void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return count(kAllocation, "memalign"), __libc_memalign(alignment, size);
}
BODEFLOW_HOOK void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return count(kAllocation, "aligned_alloc"), __libc_memalign(alignment, size);
}
BODEFLOW_HOOK int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  count(kAllocation, "posix_memalign");
  *block = __libc_memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
BODEFLOW_HOOK void free(void* block) noexcept {
  if (block != nullptr) count(kAllocation, "free");
  __libc_free(block);
}

// Each function of the C library below is passed on to the next library that has it.
#define BODEFLOW_PASS(result, name, kind, parameters, arguments) \
  BODEFLOW_HOOK result name parameters {                         \
    static const auto real = next<result(*) parameters>(#name);  \
    count(kind, #name);                                          \
    return real arguments;                                       \
  }
#define BODEFLOW_PASS_NOEXCEPT(result, name, kind, parameters, arguments) \
  BODEFLOW_HOOK result name parameters noexcept {                         \
    static const auto real = next<result(*) parameters>(#name);           \
    count(kind, #name);                                                   \
    return real arguments;                                                \
  }

BODEFLOW_PASS_NOEXCEPT(int, pthread_mutex_lock, kLock, (pthread_mutex_t * mutex), (mutex))
BODEFLOW_PASS_NOEXCEPT(int, pthread_rwlock_rdlock, kLock, (pthread_rwlock_t * lock), (lock))
BODEFLOW_PASS_NOEXCEPT(int, pthread_rwlock_wrlock, kLock, (pthread_rwlock_t * lock), (lock))
BODEFLOW_PASS(int, pthread_cond_wait, kLock, (pthread_cond_t * condition, pthread_mutex_t* mutex), (condition, mutex))
BODEFLOW_PASS(int, sem_wait, kLock, (sem_t * semaphore), (semaphore))
BODEFLOW_PASS(ssize_t, read, kCall, (int file, void* to, std::size_t size), (file, to, size))
BODEFLOW_PASS(ssize_t, write, kCall, (int file, const void* from, std::size_t size), (file, from, size))
BODEFLOW_PASS(std::FILE*, fopen, kCall, (const char* path, const char* mode), (path, mode))
BODEFLOW_PASS(std::FILE*, fopen64, kCall, (const char* path, const char* mode), (path, mode))
BODEFLOW_PASS(std::size_t, fread, kCall, (void* to, std::size_t size, std::size_t n, std::FILE* file), (to, size, n, file))
BODEFLOW_PASS(std::size_t, fwrite, kCall, (const void* from, std::size_t size, std::size_t n, std::FILE* file),
              (from, size, n, file))
BODEFLOW_PASS(int, fputs, kCall, (const char* text, std::FILE* file), (text, file))
BODEFLOW_PASS(int, fputc, kCall, (int c, std::FILE* file), (c, file))
BODEFLOW_PASS(int, putc, kCall, (int c, std::FILE* file), (c, file))
BODEFLOW_PASS(int, putchar, kCall, (int c), (c))
BODEFLOW_PASS(int, puts, kCall, (const char* text), (text))
BODEFLOW_PASS(int, fflush, kCall, (std::FILE * file), (file))
BODEFLOW_PASS(int, nanosleep, kCall, (const timespec* time, timespec* rest), (time, rest))
BODEFLOW_PASS(int, clock_nanosleep, kCall, (clockid_t clock, int flags, const timespec* time, timespec* rest),
              (clock, flags, time, rest))
BODEFLOW_PASS(int, usleep, kCall, (unsigned microseconds), (microseconds))

BODEFLOW_HOOK int printf(const char* format, ...) {
  count(kCall, "printf");
  va_list arguments;
  va_start(arguments, format);
  const int written = std::vfprintf(stdout, format, arguments);
  va_end(arguments);
  return written;
}
BODEFLOW_HOOK int fprintf(std::FILE* file, const char* format, ...) {
  count(kCall, "fprintf");
  va_list arguments;
  va_start(arguments, format);
  const int written = std::vfprintf(file, format, arguments);
  va_end(arguments);
  return written;
}
BODEFLOW_HOOK int __printf_chk(int, const char* format, ...) {
  count(kCall, "printf");
  va_list arguments;
  va_start(arguments, format);
  const int written = std::vfprintf(stdout, format, arguments);
  va_end(arguments);
  return written;
}
BODEFLOW_HOOK int __fprintf_chk(std::FILE* file, int, const char* format, ...) {
  count(kCall, "fprintf");
  va_list arguments;
  va_start(arguments, format);
  const int written = std::vfprintf(file, format, arguments);
  va_end(arguments);
  return written;
}
}

#endif
