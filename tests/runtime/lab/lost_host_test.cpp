// Hosts that are lost in the middle of their phase and go on as new parts, in one process over links in memory.
#include <cmath>
#include <random>
#include <thread>

#include "../execute/bench.hpp"
#include "../execute/collector.hpp"
#include "catch.hpp"
#include "lab/remote_blocks.hpp"
#include "memory_link.hpp"
#include "plan/facts.hpp"

namespace bodeflow::test {
namespace {

using Links = std::vector<std::shared_ptr<MemoryLink>>;
using execute::Outcome;

/// A host's part that runs in a thread.
struct RunningPart {
  lab::Part part;
  std::vector<std::unique_ptr<Instance>> instances;
  std::map<int, std::shared_ptr<execute::RemoteEnd>> ends;
  std::map<int, std::shared_ptr<lab::StreamEnd>> streams;  ///< by cut
  Rate end;
  std::atomic<bool> stop{false};
  Result result;
  std::thread thread;

  std::uint64_t sample_at(int cut, std::int64_t period) const {
    for (const lab::PartEnd& one : part.ends)
      if (one.cut == cut)
        return static_cast<std::uint64_t>(period * part.facts.blocks[static_cast<std::size_t>(one.block)].repetitions);
    return 0;
  }

  void run() {
    thread = std::thread([this] {
      const auto plan = plan::make_plan(part.phase, part.facts, part.options);
      if (!plan) return;
      for (const auto& recorded : part.phase.recorded)
        result.streams[part.phase.blocks[static_cast<std::size_t>(recorded.port.block)].name + ".out"].resize(1);
      const OnSamples none;
      Collector sink(part.phase, none, result);
      execute::Options options;
      options.stop = &stop;
      options.least_end = end;
      for (const auto& [block, remote] : ends) options.remote_ends[block] = remote.get();
      result.outcome = execute::execute(part.phase, part.facts, *plan, instances, {}, sink, options);
    });
  }
  void join(bool at_once = false) {
    if (at_once) stop = true;
    if (thread.joinable()) thread.join();
  }
};

Links new_links(const lab::Layout& layout) {
  Links links;
  for (std::size_t i = 0; i < layout.cuts.size(); ++i) links.push_back(std::make_shared<MemoryLink>());
  return links;
}

struct Survived {
  std::string refused;                                ///< why the lost hosts could not go on
  std::int64_t begin = 0;                             ///< period of the phase at which they did
  Result result;                                      ///< of this machine
  std::map<std::string, std::vector<lab::Gap>> gaps;  ///< by connection, of this machine
};

/// A phase on this machine and on hosts that are lost and started again.
class Loss {
 public:
  Loss(Bench& bench, std::vector<std::string> lost, std::int64_t chunk) : bench_(bench), lost_(std::move(lost)) {
    auto whole = plan::instantiate(bench.phase, test_registry(), std::make_shared<HostServices>());
    REQUIRE(whole);
    const auto facts = plan::establish_facts(bench.phase, *whole);
    REQUIRE(facts);
    facts_ = *facts;
    options_.chunk = chunk;
    const auto layout = lab::lay_out(bench.phase, facts_, options_);
    if (!layout) FAIL(to_string(layout.error()));
    layout_ = *layout;
  }

  /// Messages of the first cut when nothing is lost.
  std::uint64_t messages() {
    const Links links = new_links(layout_);
    std::vector<std::unique_ptr<RunningPart>> parts;
    for (const std::string& host : layout_.hosts) parts.push_back(make_part(host, links));
    for (auto& part : parts) part->run();
    for (auto& part : parts) part->join();
    return links.front()->messages;
  }

  /// Loses the hosts together, when so many messages have gone over the first cut.
  Survived run(std::uint64_t messages) {
    const Links before = new_links(layout_), behind = new_links(layout_);
    before.front()->lost_after = messages;
    const auto here = make_part("", before);
    Survived survived;
    for (const auto& [cut, stream] : here->streams)
      stream->on_gap([&survived, name = name_of(cut)](const lab::Gap& gap) { survived.gaps[name].push_back(gap); });
    std::vector<std::unique_ptr<RunningPart>> parts;
    for (const std::string& host : lost_) parts.push_back(make_part(host, before));
    here->run();
    for (auto& part : parts) part->run();
    CHECK(before.front()->wait_until_lost(60.0));
    for (const auto& link : before) link->lose();
    for (auto& part : parts) part->join(true);
    go_on(*here, behind, survived);
    return survived;
  }

 private:
  const std::string& name_of(int cut) const { return layout_.cuts[static_cast<std::size_t>(cut)].name; }

  std::unique_ptr<RunningPart> make_part(const std::string& host, const Links& links) {
    auto made = std::make_unique<RunningPart>();
    made->part = lab::part_of(bench_.phase, facts_, layout_, host, options_);
    made->end = layout_.end;
    auto whole = plan::instantiate(bench_.phase, test_registry(), std::make_shared<HostServices>());
    REQUIRE(whole);
    REQUIRE(plan::establish_facts(bench_.phase, *whole));
    made->instances.resize(made->part.phase.blocks.size());
    for (const lab::PartEnd& end : made->part.ends) {
      const lab::Cut& cut = layout_.cuts[static_cast<std::size_t>(end.cut)];
      const auto& link = links[static_cast<std::size_t>(end.cut)];
      const std::string& name = made->part.phase.blocks[static_cast<std::size_t>(end.block)].name;
      lab::MadeEnd one = end.sends ? make_sample_outlet(name, cut, std::make_unique<MemoryOutlet>(link))
                                   : make_sample_inlet(name, cut, std::make_unique<MemoryInlet>(link));
      made->instances[static_cast<std::size_t>(end.block)] = std::move(one.instance);
      made->ends[end.block] = one.end;
      made->streams[end.cut] = one.stream;
    }
    for (std::size_t i = 0; i < made->part.phase.blocks.size(); ++i)
      if (!made->instances[i])
        made->instances[i] =
            std::move((*whole)[static_cast<std::size_t>(bench_.phase.block_index(made->part.phase.blocks[i].name))]);
    return made;
  }

  void go_on(RunningPart& here, const Links& behind, Survived& survived) {
    std::int64_t period = 0;
    for (int twice = 0; twice < 2; ++twice)  // a second look, where another host is lost meanwhile, changes nothing
      for (const auto& [cut, stream] : here.streams) {
        const auto sample = stream->leave();
        if (!sample) survived.refused = sample.error();
        if (!sample) return here.join(true);
        const auto samples = static_cast<std::int64_t>(here.sample_at(cut, 1));
        period = std::max(period, (static_cast<std::int64_t>(*sample) + samples - 1) / samples);
      }
    survived.begin = period = (period + layout_.periods - 1) / layout_.periods * layout_.periods;
    std::vector<std::unique_ptr<RunningPart>> next;
    for (const std::string& host : lost_) {
      next.push_back(make_part(host, behind));
      next.back()->end = begin_part_at(next.back()->part, layout_.end, period);
      for (const auto& [cut, stream] : next.back()->streams) stream->begin_at(next.back()->sample_at(cut, period));
    }
    for (const auto& [cut, stream] : here.streams) {
      lab::NewLink joined;
      joined.epoch = 1;
      if (layout_.cuts[static_cast<std::size_t>(cut)].from_host.empty())
        joined.outlet = std::make_unique<MemoryOutlet>(behind[static_cast<std::size_t>(cut)]);
      else
        joined.inlet = std::make_unique<MemoryInlet>(behind[static_cast<std::size_t>(cut)]);
      REQUIRE(stream->rejoin(std::move(joined), here.sample_at(cut, period), [] { return true; }));
    }
    for (auto& part : next) part->run();
    here.join();
    for (auto& part : next) {
      part->join();
      INFO(part->result.outcome.reason);
      CHECK(part->result.outcome.status == Outcome::Status::complete);
    }
    INFO(here.result.outcome.reason);
    CHECK(here.result.outcome.status == Outcome::Status::complete);
    survived.result = std::move(here.result);
  }

  Bench& bench_;
  std::vector<std::string> lost_;
  plan::PlanOptions options_;
  plan::Facts facts_;
  lab::Layout layout_;
};

/// Loses the hosts at the begin, at the end, and at random between, with some chunk sizes; gives what to check.
template <class Check>
void lose_everywhere(Bench& bench, const std::vector<std::string>& lost, const std::vector<std::int64_t>& chunks, Check check) {
  std::mt19937 random(1);
  for (const std::int64_t chunk : chunks) {
    Loss loss(bench, lost, chunk);
    const std::uint64_t all = loss.messages();
    REQUIRE(all > 8);
    std::vector<std::uint64_t> when = {0, 1, all - 3, all - 2, all - 1, all};
    for (int i = 0; i < 6; ++i) when.push_back(random() % all);
    for (const std::uint64_t messages : when) {
      INFO("lost after " << messages << " of " << all << " messages, chunk " << chunk);
      const Survived survived = loss.run(messages);
      INFO("goes on at " << survived.begin << survived.refused);
      if (messages + 3 < all) CHECK(survived.refused.empty());
      if (survived.refused.empty()) check(survived);
    }
  }
}

std::size_t missing(const Survived& survived) {
  std::size_t count = 0;
  for (const auto& [name, gaps] : survived.gaps)
    for (const lab::Gap& gap : gaps) count += gap.count;
  return count;
}

TEST_CASE("hosts: whenever a host is lost, every sample is that of one process or told to be missing") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("twice", "streams.gain", {{"gain", 2.0}});
  bench.add("back", "streams.gain", {{"gain", 1.0}});
  bench.connect("noise", "twice");
  bench.connect("twice", "back");
  bench.duration(4.0);
  const Result reference = bench.run();
  REQUIRE(reference.outcome.status == Outcome::Status::complete);
  bench.phase.blocks[1].host = "bench";
  bench.phase.run.restart = true;
  lose_everywhere(bench, {"bench"}, {7, 64, 400}, [&](const Survived& survived) {
    REQUIRE(survived.gaps.size() <= 1);
    const auto& back = survived.result.stream("back.out");
    const auto& wanted = reference.stream("back.out");
    REQUIRE(back.size() == wanted.size());
    CHECK(survived.result.stream("noise.out") == reference.stream("noise.out"));
    lab::Gap gap;
    if (!survived.gaps.empty()) {
      REQUIRE(survived.gaps.begin()->second.size() == 1);
      gap = survived.gaps.begin()->second.front();
      CHECK(gap.epoch == 1);
    }
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < back.size(); ++n)
      if (n >= gap.first && n < gap.first + gap.count ? !std::isnan(back[n]) : back[n] != wanted[n]) ++wrong;
    CHECK(wrong == 0);
  });
}

TEST_CASE("hosts: two hosts that are lost together go on together, a source with its first sample") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("twice", "streams.gain", {{"gain", 2.0}});
  bench.add("back", "streams.gain", {{"gain", 1.0}});
  bench.connect("noise", "twice");
  bench.connect("twice", "back");
  bench.duration(4.0);
  const Result reference = bench.run();
  bench.phase.blocks[0].host = "bench";
  bench.phase.blocks[1].host = "middle";
  bench.phase.run.restart = true;
  lose_everywhere(bench, {"bench", "middle"}, {10, 64}, [&](const Survived& survived) {
    const auto& back = survived.result.stream("back.out");
    const auto& wanted = reference.stream("back.out");
    REQUIRE(back.size() == wanted.size());
    const auto begin = std::min(static_cast<std::size_t>(survived.begin), back.size());
    const std::size_t first = begin - missing(survived);
    std::size_t wrong = 0;
    for (std::size_t n = 0; n < back.size(); ++n) {
      if (n < first) wrong += back[n] != wanted[n];
      if (n >= first && n < begin) wrong += !std::isnan(back[n]);
      if (n >= begin) wrong += back[n] != wanted[n - begin];
    }
    CHECK(wrong == 0);
  });
}

TEST_CASE("hosts: a loop goes on over a host that is lost, right up to there and without a sample that is no number") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("sum", "streams.sum");
  bench.add("plant", "streams.pole", {{"pole", 0.5}, {"delay", std::int64_t{64}}});
  bench.connect("noise", "sum.in");
  bench.connect("sum", "plant");
  bench.connect("plant", "sum.feedback");
  bench.duration(4.0);
  bench.phase.blocks[2].host = "bench";
  bench.phase.run.restart = true;
  bench.phase.run.gaps = graph::Gaps::hold;
  const Result reference = bench.run();
  lose_everywhere(bench, {"bench"}, {16}, [&](const Survived& survived) {
    auto right = survived.begin;
    for (const auto& [name, gaps] : survived.gaps)
      for (const lab::Gap& gap : gaps) right = std::min(right, static_cast<std::int64_t>(gap.first));
    const auto& sum = survived.result.stream("sum.out");
    const auto& wanted = reference.stream("sum.out");
    REQUIRE(sum.size() == wanted.size());
    CHECK(std::equal(sum.begin(), sum.begin() + std::min<std::ptrdiff_t>(right, std::ssize(sum)), wanted.begin()));
    CHECK(std::all_of(sum.begin(), sum.end(), [](double x) { return std::isfinite(x); }));
  });
}

}  // namespace
}  // namespace bodeflow::test
