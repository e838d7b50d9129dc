#pragma once

#include "plan/plan.hpp"

namespace bodeflow::plan {

/// A connection as ordering and loops see it.
struct Link {
  int from = 0, to = 0;  ///< blocks
  bool message = false;
  int edge = 0;               ///< index into Phase::streams or Phase::messages
  std::int64_t produced = 1;  ///< streams: samples a firing
  std::int64_t consumed = 1;
  std::int64_t delay = 0;  ///< streams: samples
  Rate latency;            ///< messages: seconds; zero: none

  /// Whether `from` may run after `to`, at least at the start.
  bool loose() const { return message ? latency.num > 0 : delay > 0; }
};

/// The streams of a phase, then its messages. Errors: a latency in samples where the consumer has no samples.
tl::expected<std::vector<Link>, Problems> links_of(const graph::Phase& phase, const Facts& facts);

/// Place and "a.out -> b.in" of a link.
Place place_of(const graph::Phase& phase, const Link& link);
std::string connection(const graph::Phase& phase, const Link& link);

}  // namespace bodeflow::plan
