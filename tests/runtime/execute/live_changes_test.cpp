// Changes that are asked for while a run goes on, and what can be seen of it from outside.
#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

using Catch::Matchers::Contains;
using execute::Outcome;
using observe::Change;

/// Asks for changes at the n-th piece of the counter's samples.
void ask_at(Bench& bench, observe::Watch& watch,
            std::map<int, std::vector<std::tuple<std::string, std::string, std::string>>> when) {
  bench.watch = &watch;
  bench.on_samples = [&watch, when, pieces = 0](const std::string& port) mutable -> tl::expected<void, std::string> {
    if (port != "count.out") return {};
    const auto due = when.find(++pieces);
    if (due == when.end()) return {};
    for (const auto& [block, parameter, value] : due->second) {
      const auto asked = watch.ask(1, block, parameter, value);
      if (!asked) return tl::unexpected(asked.error());
    }
    return {};
  };
}

/// The changes of a run as those of its repetition.
std::vector<execute::PastChange> past(const Bench& bench, const observe::Look& look) {
  std::vector<execute::PastChange> changes;
  for (const Change& change : look.changes) {
    const int block = bench.phase.block_index(change.block);
    const auto& type = *bench.phase.blocks[static_cast<std::size_t>(block)].type;
    if (change.status == Change::Status::taken)
      changes.push_back({block, type.parameter(change.parameter), change.value, change.position});
  }
  return changes;
}

/// The run without anybody who looks on, with the same changes at the same places, cut in every way.
void check_repetition(Bench bench, const observe::Look& look, const Result& result) {
  bench.options.past_changes = past(bench, look);
  bench.watch = nullptr;
  bench.on_samples = {};
  for (const Cut& cut : {Cut{1024, 1, 0, 0}, Cut{7, 1, 0, 0}, Cut{64, 2, 3, 0}, Cut{100, 1, 1, 5}}) {
    const Result again = bench.run(cut);
    INFO(cut.chunk << " samples, " << cut.threads << " threads: " << again.outcome.reason);
    REQUIRE(again.outcome.status == Outcome::Status::complete);
    CHECK(again.same_data(result));
  }
}

TEST_CASE("live changes: one takes effect where it is told to, and a repetition gives the same bits") {
  for (const int threads : {1, 2}) {
    Bench bench;
    bench.add("count", "streams.counter");
    bench.add("gain", "streams.gain", {{"gain", 1.0}});
    bench.connect("count", "gain");
    bench.schedule(0.2, "gain", "offset", 3.0);
    bench.duration(1.0);
    observe::Watch watch;
    ask_at(bench, watch, {{3, {{"gain", "gain", "-2"}, {"gain", "gain", "4"}}}, {8, {{"gain", "gain", "0.5"}}}});
    const Result result = bench.run({50, threads, 0, 0});
    INFO(result.outcome.reason);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    const auto look = watch.look();
    REQUIRE(look.changes.size() == 3);
    for (const Change& change : look.changes) REQUIRE(change.status == Change::Status::taken);
    const auto first = static_cast<std::size_t>(look.changes[0].position),
               last = static_cast<std::size_t>(look.changes[2].position);
    CHECK(look.changes[1].position == look.changes[0].position);
    CHECK(first >= (threads == 1 ? 100 : 0));
    CHECK(first % 50 == 0);
    CHECK(last > first);
    CHECK(look.changes[2].time_s == Approx(static_cast<double>(last) * 1e-3));
    const auto& y = result.stream("gain.out");
    for (std::size_t n = 0; n < 1000; ++n) {
      const double gain = n < first ? 1.0 : n < last ? 4.0 : 0.5;
      REQUIRE(y[n] == gain * static_cast<double>(n) + (n < 200 ? 0.0 : 3.0));
    }
    REQUIRE(result.changes.at("gain").size() == 4);
    const int gain = bench.phase.blocks[1].type->parameter("gain");
    CHECK(look.values[1][static_cast<std::size_t>(gain)].numbers == std::vector<double>{0.5});
    check_repetition(bench, look, result);
  }
}

TEST_CASE("live changes: in a loop, with records that change the same parameter at the same sample") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("pulse", "messages.pulse", {{"rate", 20.0}});
  bench.add("tuner", "messages.tuner", {{"base", 0.5}, {"slope", 0.01}});
  bench.add("sum", "streams.sum");
  bench.add("gain", "streams.gain", {{"gain", 0.5}});
  bench.add("plant", "streams.pole", {{"pole", 0.9}, {"delay", std::int64_t{1}}});
  bench.connect("count", "sum.in");
  bench.connect("sum", "gain");
  bench.connect("gain", "plant");
  bench.connect("plant", "sum.feedback");
  bench.tell("pulse", "tuner");
  bench.tell("tuner", "gain.parameters");
  bench.duration(0.6);
  observe::Watch watch;
  ask_at(bench, watch, {{2, {{"gain", "gain", "0.25"}}}, {5, {{"gain", "gain", "0.125"}}}});
  const Result result = bench.run({50, 1, 0, 0});
  INFO(result.outcome.reason);
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  const auto look = watch.look();
  REQUIRE(look.changes.size() == 2);
  CHECK(look.changes[0].status == Change::Status::taken);
  check_repetition(bench, look, result);
}

TEST_CASE("live changes: a block without streams takes them between its records, also in a repetition") {
  for (const char* relay : {"messages.relay", "messages.slow_relay"}) {
    Bench bench;
    bench.add("count", "streams.counter");
    bench.add("pulse", "messages.pulse", {{"rate", 100.0}});
    bench.add("relay", relay);
    bench.tell("pulse", "relay", after(1, 300));
    bench.duration(1.0);
    observe::Watch watch;
    ask_at(bench, watch, {{4, {{"relay", "factor", "3"}}}, {9, {{"relay", "factor", "5"}}}});
    const Result result = bench.run({50, 1, 0, 0});
    INFO(relay << ": " << result.outcome.reason);
    REQUIRE(result.outcome.status == Outcome::Status::complete);
    const auto look = watch.look();
    REQUIRE(look.changes.size() == 2);
    REQUIRE(look.changes[1].status == Change::Status::taken);
    CHECK(look.changes[0].time_s >= 0.15);
    check_repetition(bench, look, result);
  }
}

TEST_CASE("live changes: what a block refuses is told, its value stays, and the run goes on") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("fault", "faults.fault", {{"way", std::string("picky")}});
  bench.connect("count", "fault");
  bench.duration(0.5);
  observe::Watch watch;
  ask_at(bench, watch, {{2, {{"fault", "level", "0.5"}}}, {4, {{"fault", "level", "2"}}}});
  const Result result = bench.run({50, 1, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  const auto look = watch.look();
  REQUIRE(look.changes.size() == 2);
  CHECK(look.changes[0].status == Change::Status::taken);
  CHECK(look.changes[1].status == Change::Status::refused);
  CHECK_THAT(look.changes[1].refusal, Contains("a level above one would break it"));
  CHECK(result.stream("fault.out")[499] == 499.5);
  CHECK(result.changes.at("fault").size() == 1);
  const auto news = watch.news();
  CHECK(news.size() == 2);
  CHECK(watch.news().empty());
}

TEST_CASE("live changes: what comes too late is told to be missed") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("gain", "streams.gain");
  bench.connect("count", "gain");
  bench.duration(0.2);
  observe::Watch watch;
  ask_at(bench, watch, {{4, {{"gain", "gain", "2"}}}});
  const Result result = bench.run({50, 1, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  // The last piece of the counter comes before the gain's last chunk: in effect there, or not at all.
  REQUIRE(watch.look().changes.size() == 1);
  CHECK(watch.look().changes[0].status != Change::Status::waiting);
  const auto late = watch.ask(1, "gain", "gain", "2");
  REQUIRE_FALSE(late);
  CHECK(late.error() == "the phase that was shown does not run any more");
}

TEST_CASE("live changes: what can't be is refused by name, as in a graph file") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("gain", "streams.gain");
  bench.connect("count", "gain");
  bench.duration(0.2);
  observe::Watch watch;
  std::vector<std::string> said;
  bench.watch = &watch;
  bench.on_samples = [&](const std::string& port) -> tl::expected<void, std::string> {
    if (port != "count.out" || !said.empty()) return {};
    for (const auto& [generation, block, parameter, value] :
         std::vector<std::tuple<std::uint64_t, std::string, std::string, std::string>>{{7, "gain", "gain", "1"},
                                                                                       {1, "gian", "gain", "1"},
                                                                                       {1, "gain", "gian", "1"},
                                                                                       {1, "gain", "fixed", "1"},
                                                                                       {1, "gain", "gain", "1000"},
                                                                                       {1, "gain", "gain", "2 furlongs"},
                                                                                       {1, "gain", "gain", "nan"},
                                                                                       {1, "gain", "gain", ""},
                                                                                       {1, "gain", "gain", "[1, 2]"},
                                                                                       {1, "gain", "steps", "1.5"},
                                                                                       {1, "gain", "mode", "fast"},
                                                                                       {1, "gain", "list", "[1, 2"},
                                                                                       {1, "gain", "gain", "\xff"}}) {
      const auto asked = watch.ask(generation, block, parameter, value);
      said.push_back(asked ? "accepted" : asked.error());
    }
    return {};
  };
  REQUIRE(bench.run({50, 1, 0, 0}).outcome.status == Outcome::Status::complete);
  const std::vector<std::string> expected = {
      "does not run any more",
      "unknown block 'gian' (did you mean 'gain'?)",
      "block 'gain': unknown parameter 'gian' (did you mean 'gain'?)",
      "block 'gain': parameter 'fixed' can't change while the graph runs; live parameters: gain",
      "block 'gain': parameter 'gain': found '1000', allowed: at least -100 and at most 100",
      "block 'gain': parameter 'gain': ",
      "block 'gain': parameter 'gain': ",
      "block 'gain': parameter 'gain': found nothing, allowed: a number",
      "block 'gain': parameter 'gain': found a list, allowed: a number",
      "block 'gain': parameter 'steps': ",
      "block 'gain': parameter 'mode': found 'fast', allowed: plain, negated",
      "block 'gain': parameter 'list': not valid YAML",
      "block 'gain': parameter 'gain': not UTF-8"};
  REQUIRE(said.size() == expected.size());
  for (std::size_t i = 0; i < said.size(); ++i) CHECK_THAT(said[i], Contains(expected[i]));
  CHECK(watch.look().changes.empty());
}

TEST_CASE("live changes: no more than a few may wait") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("gain", "streams.gain");
  bench.connect("count", "gain");
  bench.duration(0.1);
  observe::Watch watch;
  int accepted = 0;
  std::string refusal;
  bench.watch = &watch;
  bench.on_samples = [&](const std::string& port) -> tl::expected<void, std::string> {
    for (int i = 0; port == "count.out" && i < 70 && refusal.empty(); ++i) {
      const auto asked = watch.ask(1, "gain", "gain", std::to_string(i));
      if (asked)
        ++accepted;
      else
        refusal = asked.error();
    }
    return {};
  };
  REQUIRE(bench.run({100, 1, 0, 0}).outcome.status == Outcome::Status::complete);
  CHECK(accepted == static_cast<int>(observe::Watch::kMostWaiting));
  CHECK(refusal == "64 changes wait to take effect, that many at most");
}

TEST_CASE("what is seen of a run: firings, records, the time that is done, buffers between threads") {
  Bench bench;
  bench.add("count", "streams.counter");
  bench.add("gain", "streams.gain");
  bench.add("frame", "messages.frame", {{"length", std::int64_t{100}}});
  bench.connect("count", "gain");
  bench.connect("gain", "frame");
  bench.duration(1.0);
  observe::Watch watch;
  bench.watch = &watch;
  observe::Look middle;
  bench.on_samples = [&, pieces = 0](const std::string& port) mutable -> tl::expected<void, std::string> {
    if (port == "gain.out" && ++pieces == 10) middle = watch.look();
    return {};
  };
  const Result result = bench.run({50, 2, 0, 0});
  REQUIRE(result.outcome.status == Outcome::Status::complete);
  REQUIRE(result.threads == 2);
  CHECK(middle.runs);
  CHECK(middle.state.firings[0] >= 450);
  REQUIRE(middle.state.rings.size() >= 1);
  for (const auto& ring : middle.state.rings) {
    CHECK(ring.slots >= 2);
    CHECK(ring.filled >= 0);
    CHECK(ring.filled <= ring.slots);
  }
  const observe::Look end = watch.look();
  CHECK_FALSE(end.runs);
  CHECK(end.state.firings == std::vector<std::int64_t>{1000, 1000, 10});
  CHECK(end.state.progress.time_s == 1.0);
  REQUIRE(end.records.size() == 1);
  CHECK(end.records[0].key == "test.frame");
  CHECK(end.records[0].count == result.records.at("frame.sum").size());
  const auto& last = result.records.at("frame.sum").back();
  CHECK(std::vector<std::uint8_t>(end.records[0].record.bytes(), end.records[0].record.bytes() + end.records[0].record.size()) ==
        last.bytes);
  CHECK(end.records[0].time_s == last.time_s);
}

}  // namespace
}  // namespace bodeflow::test
