#include "phases/excitation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>

#include "execute/execute.hpp"
#include "phases/run.hpp"
#include "phases/services.hpp"

namespace bodeflow::phases {
namespace {

using Marks = std::vector<bool>;  // by block

/// Follows all that streams and records may.
class Paths {
 public:
  explicit Paths(const graph::Phase& phase) : phase_(phase) {
    for (const auto& edge : phase.streams) arcs_.emplace_back(edge.from.block, edge.to.block);
    for (const auto& edge : phase.messages) arcs_.emplace_back(edge.from.block, edge.to.block);
  }

  /// The marked blocks and all in front of them.
  Marks before(Marks marks) const {
    return spread(std::move(marks), [](const auto& arc) { return std::pair(arc.second, arc.first); });
  }
  /// The marked blocks and all behind them.
  Marks behind(Marks marks) const {
    return spread(std::move(marks), [](const auto& arc) { return arc; });
  }
  Marks none() const { return Marks(phase_.blocks.size(), false); }

 private:
  template <class Direction>
  Marks spread(Marks marks, Direction direction) const {
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& arc : arcs_) {
        const auto [from, to] = direction(arc);
        if (!marks[static_cast<std::size_t>(from)] || marks[static_cast<std::size_t>(to)]) continue;
        marks[static_cast<std::size_t>(to)] = true;
        changed = true;
      }
    }
    return marks;
  }

  const graph::Phase& phase_;
  std::vector<std::pair<int, int>> arcs_;
};

/// Looks at recorded streams; ends the run when its time is over.
class Looker final : public execute::Sink {
 public:
  Looker(const graph::Phase& phase, const plan::Facts& facts, double most_s)
      : begin_(std::chrono::steady_clock::now()), most_s_(most_s) {
    for (const auto& recorded : phase.recorded) {
      const StreamFacts& stream =
          facts.blocks[static_cast<std::size_t>(recorded.port.block)].outputs[static_cast<std::size_t>(recorded.port.port)];
      seen_.push_back({stream, 0, std::vector<Extremes>(stream.channels), std::vector<double>(stream.channels, 0.0)});
    }
  }

  tl::expected<void, std::string> samples(int recorded, const void* const* channels, std::uint64_t count) override {
    Seen& seen = seen_[static_cast<std::size_t>(recorded)];
    for (std::size_t c = 0; c < seen.channels.size(); ++c) look(seen, c, channels[c], count);
    seen.samples += count;
    out_of_time_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count() > most_s_;
    if (out_of_time_) return tl::unexpected(std::string("enough"));
    return {};
  }
  tl::expected<void, std::string> record(graph::End, const SharedRecord&, double) override { return {}; }
  void changed(int, int, const ParameterValue&, std::uint64_t, execute::Cause) override {}

  bool out_of_time() const { return out_of_time_; }
  std::vector<Extremes> extremes(std::size_t recorded) const {
    return seen_[recorded].samples == 0 ? std::vector<Extremes>{} : seen_[recorded].channels;
  }

 private:
  struct Seen {
    StreamFacts stream;
    std::uint64_t samples = 0;
    std::vector<Extremes> channels;
    std::vector<double> last;
  };

  static void look(Seen& seen, std::size_t channel, const void* samples, std::uint64_t count) {
    Extremes& extremes = seen.channels[channel];
    const double rate = seen.stream.rate.hz();
    for (std::uint64_t n = 0; n < count; ++n) {
      const double x = seen.stream.element == BF_C64 ? std::abs(static_cast<const std::complex<double>*>(samples)[n])
                                                     : static_cast<const double*>(samples)[n];
      if (!std::isfinite(x)) {
        ++extremes.not_finite;
        continue;
      }
      const double largest = std::max(std::abs(extremes.lowest), std::abs(extremes.highest));
      if (extremes.finite == 0 || std::abs(x) > largest) extremes.largest_at_s = static_cast<double>(seen.samples + n) / rate;
      if (extremes.finite++ == 0) extremes.lowest = extremes.highest = x;
      extremes.lowest = std::min(extremes.lowest, x);
      extremes.highest = std::max(extremes.highest, x);
      extremes.steepest = std::max(extremes.steepest, std::abs(x - seen.last[channel]) * rate);
      seen.last[channel] = x;
    }
  }

  std::chrono::steady_clock::time_point begin_;
  double most_s_;
  std::vector<Seen> seen_;
  bool out_of_time_ = false;
};

/// The chosen blocks as a phase of their own, simulated.
graph::Phase part_of(const graph::Phase& phase, const Marks& chosen, const std::vector<Excitation>& kept, double end_s) {
  graph::Phase part;
  part.name = phase.name;
  part.place = phase.place;
  part.run = phase.run;
  part.run.clock = graph::Clock::simulated;
  part.run.priority.reset();
  if (!part.run.duration_s && end_s > 0.0) part.run.duration_s = end_s;
  std::vector<int> place(phase.blocks.size(), -1);
  for (std::size_t i = 0; i < phase.blocks.size(); ++i) {
    if (!chosen[i]) continue;
    place[i] = static_cast<int>(part.blocks.size());
    part.blocks.push_back(phase.blocks[i]);
  }
  const auto moved = [&](graph::End& end) {
    end.block = place[static_cast<std::size_t>(end.block)];
    return end.block >= 0;
  };
  for (graph::StreamEdge edge : phase.streams)
    if (moved(edge.from) && moved(edge.to)) part.streams.push_back(edge);
  for (graph::MessageEdge edge : phase.messages)
    if (moved(edge.from) && moved(edge.to)) part.messages.push_back(edge);
  for (graph::ScheduledChange change : phase.schedule) {
    change.block = place[static_cast<std::size_t>(change.block)];
    if (change.block >= 0) part.schedule.push_back(std::move(change));
  }
  for (const Excitation& excitation : kept) {
    graph::RecordedPort recorded{excitation.from, BF_STREAM};
    if (moved(recorded.port)) part.recorded.push_back(recorded);
  }
  return part;
}

class Finder {
 public:
  explicit Finder(const graph::Phase& phase) : phase_(phase), paths_(phase), unknown_(paths_.none()) {
    for (std::size_t i = 0; i < phase.blocks.size(); ++i) unknown_[i] = is_outside(phase.blocks[i]);
    for (const auto& reference : phase.references) unknown_[static_cast<std::size_t>(reference.to.block)] = true;
    dependent_ = paths_.behind(unknown_);
  }

  Excitations inputs() {
    for (const auto& edge : phase_.streams)
      if (is_outside(phase_.blocks[static_cast<std::size_t>(edge.to.block)])) add_input(edge);
    return std::move(found_);
  }

  /// All that can be run by itself and is in front of the found streams.
  Marks runnable(const std::vector<Excitation>& streams) const {
    Marks ends = paths_.none();
    for (const Excitation& stream : streams) ends[static_cast<std::size_t>(stream.from.block)] = true;
    return paths_.before(std::move(ends));
  }

 private:
  bool dependent(int block) const { return dependent_[static_cast<std::size_t>(block)]; }

  void add_input(const graph::StreamEdge& edge) {
    DeviceInput input{edge.to, {}, {}};
    if (!dependent(edge.from.block)) {
      input.excitations.push_back(stream(edge.from));
    } else {
      Marks end = paths_.none();
      end[static_cast<std::size_t>(edge.from.block)] = true;
      const Marks before = paths_.before(std::move(end));
      for (std::size_t i = 0; i < before.size(); ++i)
        if (before[i] && unknown_[i]) input.depends_on.push_back(static_cast<int>(i));
      for (const auto& other : phase_.streams)
        if (!dependent(other.from.block) && dependent(other.to.block) && before[static_cast<std::size_t>(other.to.block)])
          add_once(input.excitations, stream(other.from));
    }
    found_.inputs.push_back(std::move(input));
  }

  std::size_t stream(const graph::End& from) {
    for (std::size_t i = 0; i < found_.streams.size(); ++i)
      if (found_.streams[i].from == from) return i;
    found_.streams.push_back({from, {}});
    return found_.streams.size() - 1;
  }

  static void add_once(std::vector<std::size_t>& list, std::size_t index) {
    if (std::find(list.begin(), list.end(), index) == list.end()) list.push_back(index);
  }

  const graph::Phase& phase_;
  Paths paths_;
  Marks unknown_, dependent_;
  Excitations found_;
};

double end_of(const plan::Facts& facts) {
  double end_s = 0.0;
  for (const auto& block : facts.blocks)
    if (block.firings >= 0 && block.firing_rate.known())
      end_s = std::max(end_s, static_cast<double>(block.firings) / block.firing_rate.hz());
  return end_s;
}

}  // namespace

bool is_outside(const graph::Block& block) { return block.type->has_role("device") || block.type->has_role("network"); }

Excitations excitations_of(const graph::Phase& phase, const plan::Facts& facts, Registry& registry, double most_s) {
  Finder finder(phase);
  Excitations found = finder.inputs();
  if (found.streams.empty()) return found;
  const double end_s = end_of(facts);
  const graph::Phase part = part_of(phase, finder.runnable(found.streams), found.streams, end_s);
  const Services services;
  auto prepared = prepare(part, registry, services.host(), {1, {}});
  if (!prepared) {
    found.failure = to_string(prepared.error());
    found.streams.clear();
    return found;
  }
  Looker looker(part, prepared->facts, most_s);
  execute::Options options;
  options.seed = seed_of(phase, 0);
  options.metrics = false;
  options.watchdog_s = phase.run.watchdog_s;
  const auto outcome = execute::execute(part, prepared->facts, prepared->plan, prepared->instances, {}, looker, options);
  if (outcome.hung)  // the stuck block must not be destroyed under its thread
    for (auto& instance : prepared->instances) (void)instance.release();
  found.time_s = outcome.time_s;
  found.whole = outcome.status == execute::Outcome::Status::complete;
  if (!found.whole && !looker.out_of_time()) {
    found.failure = outcome.failed_block < 0
                        ? outcome.reason
                        : "block '" + part.blocks[static_cast<std::size_t>(outcome.failed_block)].name + "': " + outcome.reason;
    found.streams.clear();
    return found;
  }
  for (std::size_t i = 0; i < found.streams.size(); ++i) found.streams[i].channels = looker.extremes(i);
  return found;
}

}  // namespace bodeflow::phases
