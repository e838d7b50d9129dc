#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "graph/graph.hpp"

namespace bodeflow::plan {

struct Facts;
struct Plan;

/// A limit of the graph in numbers of its stream's unit.
struct Limit {
  std::string signal;                   ///< "drive.feedback"
  std::string unit;                     ///< of its values; rates are per second
  std::vector<std::uint32_t> channels;  ///< ascending
  std::vector<std::string> names;       ///< of these channels; numbers where they have none
  bool all_channels = true;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double rate = std::numeric_limits<double>::infinity();  ///< per second
  double sample_rate_hz = 0.0;
  graph::OnViolation on_violation = graph::OnViolation::stop;
  bool input = false;
  /// An input's value before its first sample, by channel of `channels`: the one nearest to 0 that all limits of the port allow.
  std::vector<double> start;
  /// Samples of the signal from a violation until it has had its effect on all blocks, at most: 0 where an input is held within
  /// the limit; where the run ends a chunk, and one for each further thread (a block whose input ends it gets nothing from the
  /// violating sample on). In seconds too.
  std::int64_t latency_samples = 0;
  double latency_s = 0.0;
};

/// The limits of a phase in its order. Errors: a port without stream, an unknown channel, a wrong unit, bounds that no value
/// fulfils, of one limit or of several, and a latency longer than the limit's time, with what to change.
tl::expected<std::vector<Limit>, Problems> limits_of(const graph::Phase& phase, const Facts& facts, const Plan& plan);

/// "clamp", "stop", "warn".
const char* action_name(graph::OnViolation action);
/// "-1500 to 1500 rpm, at most 2000 rpm/s": what is allowed.
std::string bounds_text(const Limit& limit);
/// "drive.feedback, speed: at most 1650 rpm; stop, within 1 sample (20 ms)".
std::string to_text(const Limit& limit);
nlohmann::json to_json(const Limit& limit);
/// A number with its unit: "1650 rpm"; "0.5" without one.
std::string value_text(double value, const std::string& unit);

}  // namespace bodeflow::plan
