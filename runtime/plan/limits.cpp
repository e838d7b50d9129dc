#include "plan/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "graph/node.hpp"
#include "graph/scalar.hpp"
#include "plan/join_limits.hpp"
#include "plan/names.hpp"
#include "plan/plan.hpp"

namespace bodeflow::plan {
namespace {

/// Room for the rounding of times, far below a sample.
constexpr double kTimeRounding = 1e-9;

/// "rpm/s" of "rpm"; any unit stays any.
std::string per_second(const std::string& unit) { return unit.empty() ? "" : unit + "/s"; }

class Reader {
 public:
  Reader(const graph::Phase& phase, const Facts& facts, const Plan& plan, const graph::Limit& written, Problems& problems)
      : facts_(facts), plan_(plan), written_(written), problems_(problems) {
    const auto block = static_cast<std::size_t>(written.port.block), port = static_cast<std::size_t>(written.port.port);
    const Facts::Block& owner = facts.blocks[block];
    stream_ = written.input ? &owner.inputs[port] : &owner.outputs[port];
    flow_ = written.input ? &owner.input_flows[port] : &owner.output_flows[port];
    limit_.signal = written.input ? stream_input(phase, written.port) : stream_output(phase, written.port);
    limit_.input = written.input;
    limit_.on_violation = written.on_violation;
  }

  Limit read() {
    const std::size_t before = problems_.size();
    if (!stream_->known)
      problem(written_.place, "is not connected: there is nothing to limit");
    else if (stream_->element != BF_F64)
      problem(written_.place, "is complex; allowed: real streams");
    else
      read_channels();
    if (problems_.size() == before) read_unit();
    if (problems_.size() == before) read_bounds();
    if (problems_.size() == before) find_latency();
    return std::move(limit_);
  }

 private:
  void problem(const Place& place, const std::string& text) {
    problems_.push_back({place, fmt::format("limits: '{}' {}", limit_.signal, text)});
  }

  std::string name(std::uint32_t channel) const {
    return channel < stream_->channel_names.size() ? stream_->channel_names[channel] : std::to_string(channel);
  }

  void read_channels() {
    limit_.all_channels = written_.channel.empty();
    std::vector<std::string> names;
    for (std::uint32_t c = 0; c < stream_->channels; ++c) names.push_back(name(c));
    const bool named = std::find(names.begin(), names.end(), written_.channel) != names.end();
    for (std::uint32_t c = 0; c < stream_->channels; ++c) {
      const std::string number = std::to_string(c);
      if (!limit_.all_channels && written_.channel != (named ? names[c] : number)) continue;
      limit_.channels.push_back(c);
      limit_.names.push_back(names[c]);
    }
    if (limit_.channels.empty())
      problem(written_.channel_place, fmt::format("has no channel {}{}; channels: {}", graph::quote(written_.channel),
                                                  did_you_mean(written_.channel, names), graph::listed(names)));
  }

  void read_unit() {
    limit_.unit = stream_->unit;
    if (stream_->channel_units.empty()) return;
    limit_.unit = stream_->channel_units[limit_.channels.front()];
    for (const std::uint32_t c : limit_.channels)
      if (stream_->channel_units[c] != limit_.unit)
        return problem(written_.place, fmt::format("has channels of different units ({}); allowed: a limit for each, with "
                                                   "'channel'",
                                                   graph::listed(stream_->channel_units)));
  }

  void read_number(const std::optional<graph::Quantity>& quantity, const char* key, const std::string& unit, double& value) {
    if (!quantity) return;
    if (const auto number = graph::number_of(quantity->text, unit))
      value = *number;
    else
      problems_.push_back({quantity->place, fmt::format("limits: '{}': {}: {}", limit_.signal, key, number.error())});
  }

  void read_bounds() {
    read_number(written_.min, "min", limit_.unit, limit_.min);
    read_number(written_.max, "max", limit_.unit, limit_.max);
    read_number(written_.rate, "rate", per_second(limit_.unit), limit_.rate);
    if (limit_.min > limit_.max)
      problem(written_.min->place,
              fmt::format("has min {} above max {}", value_text(limit_.min, limit_.unit), value_text(limit_.max, limit_.unit)));
    if (limit_.rate <= 0.0)
      problem(written_.rate->place, fmt::format("has rate {}; allowed: above 0", graph::quote(written_.rate->text)));
    limit_.sample_rate_hz = stream_->rate.hz();
  }

  void find_latency() {
    if (written_.input && written_.on_violation != graph::OnViolation::stop) return;
    const auto block = static_cast<std::size_t>(written_.port.block);
    const auto threads = static_cast<std::int64_t>(plan_.partitions.size());
    limit_.latency_samples = plan_.repetitions * facts_.blocks[block].repetitions * flow_->samples * threads;
    limit_.latency_s = plan_.latency_s;
    if (!written_.time_s || limit_.latency_s <= *written_.time_s * (1.0 + kTimeRounding)) return;
    const double period_s = facts_.period.hz();
    const bool possible = period_s <= *written_.time_s * (1.0 + kTimeRounding);
    problem(written_.time_place,
            fmt::format("must act within {}, the plan needs {} (chunks of {}, {}); allowed: {}", seconds_text(*written_.time_s),
                        seconds_text(limit_.latency_s), seconds_text(plan_.chunk_s), count_text(threads, "thread"),
                        possible ? fmt::format("a longer time, or run: {{latency: {}}}", seconds_text(*written_.time_s))
                                 : fmt::format("at least {}, the common period of all sample rates, with run: {{latency: {}}}",
                                               seconds_text(period_s), seconds_text(period_s))));
  }

  const Facts& facts_;
  const Plan& plan_;
  const graph::Limit& written_;
  Problems& problems_;
  const StreamFacts* stream_;
  const Flow* flow_;
  Limit limit_;
};

}  // namespace

tl::expected<std::vector<Limit>, Problems> limits_of(const graph::Phase& phase, const Facts& facts, const Plan& plan) {
  std::vector<Limit> limits;
  Problems problems;
  for (const graph::Limit& written : phase.limits) limits.push_back(Reader(phase, facts, plan, written, problems).read());
  if (problems.empty()) join_limits(phase, limits, problems);
  if (!problems.empty()) return tl::unexpected(std::move(problems));
  return limits;
}

const char* action_name(graph::OnViolation action) {
  switch (action) {
    case graph::OnViolation::clamp:
      return "clamp";
    case graph::OnViolation::stop:
      return "stop";
    default:
      return "warn";
  }
}

std::string value_text(double value, const std::string& unit) {
  return fmt::format("{:.6g}{}", value, unit.empty() || unit == "1" ? "" : " " + unit);
}

std::string bounds_text(const Limit& limit) {
  const bool low = std::isfinite(limit.min), high = std::isfinite(limit.max);
  std::string text;
  if (low && high) text = fmt::format("{:.6g} to {}", limit.min, value_text(limit.max, limit.unit));
  if (low && !high) text = "at least " + value_text(limit.min, limit.unit);
  if (high && !low) text = "at most " + value_text(limit.max, limit.unit);
  if (std::isfinite(limit.rate))
    text += fmt::format("{}changes of at most {}", text.empty() ? "" : ", ",
                        value_text(limit.rate, limit.unit.empty() ? "1/s" : per_second(limit.unit)));
  return text;
}

std::string to_text(const Limit& limit) {
  const std::string channel = limit.all_channels ? "" : ", channel " + limit.names.front();
  const bool ends_behind = limit.input && limit.on_violation == graph::OnViolation::stop;
  std::string when = limit.input ? "from the same sample on" : "";
  if (!limit.input || ends_behind)
    when += fmt::format("{}within {} ({})", ends_behind ? ", other blocks " : "", count_text(limit.latency_samples, "sample"),
                        seconds_text(limit.latency_s));
  return fmt::format("{}{}: {}; {}, {}", limit.signal, channel, bounds_text(limit), action_name(limit.on_violation), when);
}

nlohmann::json to_json(const Limit& limit) {
  const auto bound = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); };
  return {{"signal", limit.signal},
          {"side", limit.input ? "input" : "output"},
          {"channels", limit.names},
          {"unit", limit.unit},
          {"min", bound(limit.min)},
          {"max", bound(limit.max)},
          {"rate_per_s", bound(limit.rate)},
          {"on_violation", action_name(limit.on_violation)},
          {"latency_samples", limit.latency_samples},
          {"latency_s", limit.latency_s}};
}

}  // namespace bodeflow::plan
