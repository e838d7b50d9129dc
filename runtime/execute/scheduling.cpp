#include "execute/scheduling.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace bodeflow::execute {
namespace {

std::string priority_refused(int priority, int error) {
  if (error != EPERM) return fmt::format("priority {}: {}", priority, std::strerror(error));
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  return fmt::format(
      "priority {} is not permitted (limit of rtprio: {}): the run goes on without it; to permit it, add '@realtime - rtprio "
      "{}' to /etc/security/limits.d/realtime.conf and the user to that group, or give the program CAP_SYS_NICE, or set "
      "LimitRTPRIO={} in its systemd unit",
      priority, limit.rlim_cur, priority, priority);
}

/// With a limit on locked memory, locking all that is to come would let later allocations fail.
bool limited() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return false;
  // The kernel asks the same question of a process without CAP_IPC_LOCK: one page more than the limit.
  const std::size_t size = static_cast<std::size_t>(limit.rlim_cur) + (std::size_t{1} << 12U);
  void* page = mmap(nullptr, size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (page == MAP_FAILED) return true;
  const bool refused = mlock2(page, size, MLOCK_ONFAULT) != 0;
  munmap(page, size);
  return refused;
}

}  // namespace

LockedMemory::LockedMemory(const graph::RunSettings& run, const Warn& warn) {
  if (!run.priority) return;
  if (!limited()) {
    locked_ = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    if (locked_ || !warn) return;
    warn(fmt::format("priority: memory can't be locked: {}; the run goes on without", std::strerror(errno)));
    return;
  }
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (warn)
    warn(fmt::format(
        "priority: memory is not locked (limit of memlock: {} KiB): the run goes on without; to permit it, add '@realtime - "
        "memlock unlimited' to /etc/security/limits.d/realtime.conf and the user to that group, or give the program "
        "CAP_IPC_LOCK, "
        "or set LimitMEMLOCK=infinity in its systemd unit",
        limit.rlim_cur / 1024));
}

LockedMemory::~LockedMemory() {
  if (locked_) munlockall();
}

AwakeCores::AwakeCores(const graph::RunSettings& run, const Warn& warn) {
  if (!run.priority) return;
  device_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const std::int32_t longest_us = 0;  // the kernel keeps to it until the file is closed
  if (device_ >= 0 && write(device_, &longest_us, sizeof longest_us) == sizeof longest_us) return;
  if (errno == ENOENT || !warn) return;  // without that file nothing is known to sleep
  warn(fmt::format(
      "priority: cores may sleep between chunks (/dev/cpu_dma_latency: {}): the run goes on without; to permit it, add "
      "'KERNEL==\"cpu_dma_latency\", GROUP=\"realtime\", MODE=\"0660\"' to /etc/udev/rules.d/99-realtime.rules",
      std::strerror(errno)));
}

AwakeCores::~AwakeCores() {
  if (device_ >= 0) close(device_);
}

void wake_in_time() { prctl(PR_SET_TIMERSLACK, 1UL); }

void Scheduling::say(bool& warned, const std::string& text) const {
  if (!warned && warn_) warn_(text);
  warned = true;
}

void Scheduling::apply(std::thread::native_handle_type thread) {
  if (!run_.cores.empty()) {
    const int core = run_.cores[next_++ % run_.cores.size()];
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(core), &set);
    if (const int error = pthread_setaffinity_np(thread, sizeof set, &set); error != 0 && error != ESRCH)
      say(warned_core_, fmt::format("cores: no thread can be bound to core {}: {}; the run goes on without", core,
                                    error == EINVAL ? "this process has no such core" : std::strerror(error)));
  }
  if (!run_.priority) return;
  sched_param wanted{};
  wanted.sched_priority = *run_.priority;
  if (const int error = pthread_setschedparam(thread, SCHED_FIFO, &wanted); error != 0 && error != ESRCH)
    say(warned_priority_, priority_refused(*run_.priority, error));
}

}  // namespace bodeflow::execute
