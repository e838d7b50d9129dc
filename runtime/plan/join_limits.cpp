#include "plan/join_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace bodeflow::plan {
namespace {

class Joiner {
 public:
  Joiner(const graph::Phase& phase, std::vector<Limit>& limits, Problems& problems)
      : phase_(phase), limits_(limits), problems_(problems) {}

  void join() {
    for (std::size_t i = 0; i < limits_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) check(k, i);
    if (!problems_.empty()) return;
    for (std::size_t i = 0; i < limits_.size(); ++i)
      if (limits_[i].input)
        for (const std::uint32_t channel : limits_[i].channels) limits_[i].start.push_back(start_of(i, channel));
  }

 private:
  /// One that only warns lets everything pass.
  bool acts(std::size_t i) const { return limits_[i].on_violation != graph::OnViolation::warn; }

  bool same_port(std::size_t a, std::size_t b) const {
    return phase_.limits[a].port == phase_.limits[b].port && limits_[a].input == limits_[b].input;
  }

  bool has(std::size_t i, std::uint32_t channel) const {
    return std::binary_search(limits_[i].channels.begin(), limits_[i].channels.end(), channel);
  }

  void check(std::size_t earlier, std::size_t later) {
    const Limit &a = limits_[earlier], &b = limits_[later];
    if (!acts(earlier) || !acts(later) || !same_port(earlier, later) || (a.min <= b.max && b.min <= a.max)) return;
    const auto shared = std::find_if(b.channels.begin(), b.channels.end(), [&](std::uint32_t c) { return has(earlier, c); });
    if (shared == b.channels.end()) return;
    problems_.push_back(
        {phase_.limits[later].place, fmt::format("limits: no value of '{}' is {} and, as line {} wants it, {}", b.signal,
                                                 bounds_text(b), phase_.limits[earlier].place.line, bounds_text(a))});
  }

  double start_of(std::size_t i, std::uint32_t channel) const {
    const double start = std::clamp(0.0, limits_[i].min, limits_[i].max);
    double least = -std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      if (!acts(k) || !same_port(k, i) || !has(k, channel)) continue;
      least = std::max(least, limits_[k].min);
      most = std::min(most, limits_[k].max);
    }
    return std::clamp(start, least, most);
  }

  const graph::Phase& phase_;
  std::vector<Limit>& limits_;
  Problems& problems_;
};

}  // namespace

void join_limits(const graph::Phase& phase, std::vector<Limit>& limits, Problems& problems) {
  Joiner(phase, limits, problems).join();
}

}  // namespace bodeflow::plan
