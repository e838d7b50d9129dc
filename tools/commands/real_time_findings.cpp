#include "commands/real_time_findings.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

namespace bodeflow::tools {
namespace {

namespace fs = std::filesystem;

std::string first_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Asks the kernel on a thread of its own, so that this one stays as it is.
bool may_schedule(int priority) {
  bool permitted = false;
  std::thread([&] {
    sched_param wanted{};
    wanted.sched_priority = priority;
    permitted = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
  }).join();
  return permitted;
}

Finding priority() {
  constexpr int kUsual = 80;
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  if (may_schedule(kUsual)) return {"real-time priority", "good", "SCHED_FIFO permitted", ""};
  return {"real-time priority", "note", fmt::format("not permitted up to {} (limit of rtprio: {})", kUsual, limit.rlim_cur),
          "for run: priority, add '@realtime - rtprio 80' to /etc/security/limits.d/realtime.conf and the user to that group, or "
          "'setcap cap_sys_nice+ep' on the program, or LimitRTPRIO=80 in its systemd unit"};
}

Finding locked_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (geteuid() == 0 || limit.rlim_cur == RLIM_INFINITY) return {"locked memory", "good", "unlimited", ""};
  return {"locked memory", "note", fmt::format("{} KiB", limit.rlim_cur / 1024),
          "for run: priority, add '@realtime - memlock unlimited' to /etc/security/limits.d/realtime.conf, or "
          "LimitMEMLOCK=infinity in the systemd unit"};
}

Finding sleeping_cores() {
  constexpr const char* kDevice = "/dev/cpu_dma_latency";
  if (access(kDevice, F_OK) != 0) return {"sleep of cores", "good", "not told by this system", ""};
  if (access(kDevice, W_OK) == 0) return {"sleep of cores", "good", "runs may forbid it", ""};
  return {"sleep of cores", "note", fmt::format("{} can't be written: cores may sleep between chunks", kDevice),
          "for run: priority, add 'KERNEL==\"cpu_dma_latency\", GROUP=\"realtime\", MODE=\"0660\"' to "
          "/etc/udev/rules.d/99-realtime.rules and the user to that group"};
}

Finding timer_resolution() {
  timespec step{};
  clock_getres(CLOCK_MONOTONIC, &step);
  const double resolution_us = static_cast<double>(step.tv_sec) * 1e6 + static_cast<double>(step.tv_nsec) * 1e-3;
  const std::string found = fmt::format("{:.4g} us", resolution_us);
  if (resolution_us <= 1.0) return {"kernel timers", "good", found, ""};
  return {"kernel timers", "note", found, "a kernel with CONFIG_HIGH_RES_TIMERS wakes threads to the microsecond"};
}

}  // namespace

Finding frequency_governor(const std::string& root) {
  std::map<std::string, int> governors;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root + "/sys/devices/system/cpu", error))
    if (const std::string governor = first_line(entry.path() / "cpufreq/scaling_governor"); !governor.empty())
      ++governors[governor];
  if (governors.empty()) return {"CPU frequency", "good", "not governed by this system", ""};
  std::string found;
  for (const auto& [name, cores] : governors)
    found += fmt::format("{}{} on {} core{}", found.empty() ? "" : ", ", name, cores, cores == 1 ? "" : "s");
  if (governors.size() == 1 && governors.begin()->first == "performance") return {"CPU frequency", "good", found, ""};
  return {"CPU frequency", "note", found, "'cpupower frequency-set -g performance' avoids slow wake-ups in paced runs"};
}

Finding isolated_cores(const std::string& root) {
  const std::string cores = first_line(root + "/sys/devices/system/cpu/isolated");
  if (!cores.empty()) return {"isolated cores", "good", cores, ""};
  return {"isolated cores", "note", "none",
          "to keep other work off the compute threads, boot with isolcpus=LIST and name these cores in run: cores"};
}

std::vector<Finding> real_time_findings() {
  return {priority(), locked_memory(), timer_resolution(), sleeping_cores(), frequency_governor(""), isolated_cores("")};
}

}  // namespace bodeflow::tools
