#include "transport/progress.hpp"

#include <algorithm>
#include <cstdio>

namespace bodeflow::transport {

double Progress::stalled_s() const {
  const auto since = since_ns_.load();
  return since == 0 ? 0.0 : 1e-9 * static_cast<double>(std::max<std::int64_t>(0, now_ns() - std::max(since, last_ns_.load())));
}

double Progress::waited_s() const {
  const auto since = since_ns_.load();
  return 1e-9 * static_cast<double>(total_ns_.load() + (since == 0 ? 0 : now_ns() - since));
}

Progress::Wait::Wait(Progress& progress) : progress_(progress) { progress_.since_ns_.store(now_ns()); }

Progress::Wait::~Wait() {
  progress_.total_ns_.fetch_add(now_ns() - progress_.since_ns_.load());
  progress_.since_ns_.store(0);
}

std::string seconds_text(double seconds) {
  char text[40];
  std::snprintf(text, sizeof text, "%g s", seconds);
  return text;
}

}  // namespace bodeflow::transport
