#include "plan/loop_simulation.hpp"

#include <algorithm>
#include <limits>

#include "plan/exact.hpp"
#include "plan/names.hpp"
#include "plan/order.hpp"

namespace bodeflow::plan {
namespace {

/// Entries of one schedule, at most; a longer one would not be a plan any more.
constexpr std::size_t kLongestSchedule = std::size_t{1} << 22;

class Simulation {
 public:
  Simulation(const graph::Phase& phase, LoopModel& model) : phase_(phase), model_(model), done_(model.blocks.size(), 0) {
    incoming_.resize(model.blocks.size());
    for (std::size_t i = 0; i < model.links.size(); ++i) incoming_[model.links[i].to].push_back(static_cast<int>(i));
    sequence_ = sequence();
  }

  tl::expected<std::vector<Firing>, Problems> run() {
    Problems problems;
    std::vector<std::string> said(model_.links.size());
    bool short_of = false;
    while (!finished()) {
      if (!round()) {
        grant(said);
        short_of = true;
      }
      if (schedule_.size() > kLongestSchedule) {
        return tl::unexpected(
            Problems{{place_of(phase_, *model_.links.front().link),
                      "the loop of block '" + name(0) + "' mixes rates so far apart that its schedule has more than " +
                          std::to_string(kLongestSchedule) + " entries"}});
      }
    }
    if (!short_of) return std::move(schedule_);
    for (std::size_t i = 0; i < said.size(); ++i) {
      if (!said[i].empty()) problems.push_back({place_of(phase_, *model_.links[i].link), said[i] + remedy(model_.links[i])});
    }
    return tl::unexpected(std::move(problems));
  }

 private:
  const std::string& name(int node) const { return phase_.blocks[model_.blocks[node]].name; }

  /// Blocks in the order of the data where that is possible, the rest by index.
  std::vector<int> sequence() const {
    std::vector<Arc> arcs;
    for (const LoopLink& link : model_.links) {
      if (!link.link->loose()) arcs.emplace_back(link.from, link.to);
    }
    const int nodes = static_cast<int>(model_.blocks.size());
    std::vector<int> order = topological_order(nodes, arcs);
    for (int node = 0; node < nodes; ++node) {
      if (std::find(order.begin(), order.end(), node) == order.end()) order.push_back(node);
    }
    return order;
  }

  bool finished() const { return done_ == model_.firings; }

  std::int64_t samples_on(const LoopLink& link) const {
    return link.link->delay + link.granted + done_[link.from] * link.link->produced - done_[link.to] * link.link->consumed;
  }

  /// How many firings of its consumer a link allows now, up to `wanted`.
  std::int64_t allowed(const LoopLink& link, std::int64_t wanted) const {
    if (!link.link->message) return std::min(wanted, samples_on(link) / link.link->consumed);
    if (link.ignored) return wanted;
    std::int64_t good = 0, bad = wanted + 1;
    while (bad - good > 1) {
      const std::int64_t middle = good + (bad - good) / 2;
      (model_.needed(link, done_[link.to] + middle - 1) <= done_[link.from] ? good : bad) = middle;
    }
    return good;
  }

  /// Every block once; false when none could fire.
  bool round() {
    bool fired = false;
    for (const int node : sequence_) {
      std::int64_t count = model_.firings[node] - done_[node];
      for (const int link : incoming_[node]) count = std::min(count, allowed(model_.links[link], count));
      if (count <= 0) continue;
      schedule_.push_back({model_.blocks[node], model_.has_streams[node] ? count : 0});
      done_[node] += count;
      fired = true;
    }
    return fired;
  }

  /// A cycle of links each of which holds up its consumer, in the direction of the data, from the smallest block on.
  std::vector<int> blocked_cycle() const {
    int node = 0;
    while (done_[node] == model_.firings[node]) ++node;
    std::vector<int> seen(model_.blocks.size(), -1), path;
    while (seen[node] < 0) {
      seen[node] = static_cast<int>(path.size());
      for (const int link : incoming_[node]) {
        if (allowed(model_.links[link], 1) > 0) continue;
        path.push_back(link);
        break;
      }
      node = model_.links[path.back()].from;
    }
    std::vector<int> cycle(path.begin() + seen[node], path.end());
    std::reverse(cycle.begin(), cycle.end());
    const auto first =
        std::min_element(cycle.begin(), cycle.end(), [&](int a, int b) { return model_.links[a].from < model_.links[b].from; });
    std::rotate(cycle.begin(), first, cycle.end());
    return cycle;
  }

  std::int64_t missing(const LoopLink& link) const { return link.link->consumed - samples_on(link); }

  /// The link of a cycle where help costs least: a message connection; else the fewest samples, and there a connection that
  /// leads back in the order of the file.
  int cheapest(const std::vector<int>& cycle) const {
    const auto cost = [&](int index) {
      const LoopLink& link = model_.links[index];
      return std::pair(link.link->message ? 0 : missing(link), link.from < link.to);
    };
    return *std::min_element(cycle.begin(), cycle.end(), [&](int a, int b) { return cost(a) < cost(b); });
  }

  /// Lends a stuck loop what it lacks, and keeps the cycle for the report.
  void grant(std::vector<std::string>& said) {
    const std::vector<int> cycle = blocked_cycle();
    const int index = cheapest(cycle);
    LoopLink& link = model_.links[index];
    if (link.link->message) {
      link.ignored = true;
    } else {
      link.granted += missing(link);
    }
    if (!said[index].empty()) return;
    said[index] = "the loop";
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      said[index] += (i == 0 ? " " : ", ") + connection(phase_, *model_.links[cycle[i]].link);
    }
  }

  std::string remedy(const LoopLink& link) const {
    const std::string where = connection(phase_, *link.link);
    if (!link.link->message) {
      return " cannot start: it needs at least " + std::to_string(link.granted) + " more sample" +
             (link.granted == 1 ? "" : "s") + " of delay on " + where + ", which has " + std::to_string(link.link->delay);
    }
    if (link.latency.num == 0) return " cannot start: give the connection " + where + " a latency";
    return " cannot start: the latency of the connection " + where + ", " + seconds_text(link.link->latency.hz()) +
           ", is too short";
  }

  const graph::Phase& phase_;
  LoopModel& model_;
  std::vector<std::vector<int>> incoming_;
  std::vector<int> sequence_;
  std::vector<std::int64_t> done_;
  std::vector<Firing> schedule_;
};

}  // namespace

tl::expected<std::vector<Firing>, Problems> simulate_period(const graph::Phase& phase, LoopModel model) {
  return Simulation(phase, model).run();
}

}  // namespace bodeflow::plan
