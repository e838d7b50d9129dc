#include "measure.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace bench {
namespace {

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

Cost measure(std::size_t samples, const std::function<void()>& call) {
  const auto wall = std::chrono::steady_clock::now();
  const double cpu = cpu_seconds();
  call();
  const double scale = 1e9 / static_cast<double>(samples);
  return {(cpu_seconds() - cpu) * scale, std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count() * scale};
}

double now_ns() {
  return static_cast<double>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch()).count());
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  const auto index = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  return values.at(index);
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

}  // namespace bench
