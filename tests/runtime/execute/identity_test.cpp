#include "bench.hpp"
#include "catch.hpp"

namespace bodeflow::test {
namespace {

TEST_CASE("identity: a loop-free graph gives the same bits for every chunk, boundary, call size and thread count") {
  Bench bench;
  bench.add("noise", "streams.noise", {{"channels", std::int64_t{2}}});
  bench.add("pole", "streams.pole", {{"pole", 0.97}});
  bench.add("sums", "streams.decimate", {{"factor", std::int64_t{4}}});
  bench.add("hold", "streams.hold", {{"factor", std::int64_t{4}}});
  bench.add("other", "streams.noise");
  bench.add("late", "streams.pole", {{"pole", 0.3}, {"delay", std::int64_t{37}}});
  bench.add("sum", "streams.sum");
  bench.add("frame", "messages.frame", {{"length", std::int64_t{50}}, {"closing", true}});
  bench.add("relay", "messages.relay");
  bench.connect("noise", "pole");
  bench.connect("pole", "sums");
  bench.connect("sums", "hold");
  bench.connect("other", "late");
  bench.connect("late", "sum.in");
  bench.connect("hold", "sum.feedback");
  bench.connect("sum", "frame");
  bench.tell("frame", "relay");
  bench.duration(2.217);
  bench.check_identity();
}

TEST_CASE("identity: a single-rate loop") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("sum", "streams.sum");
  bench.add("gain", "streams.gain", {{"gain", 0.7}});
  bench.add("plant", "streams.pole", {{"pole", 0.9}, {"delay", std::int64_t{1}}});
  bench.add("out", "streams.pole");
  bench.connect("noise", "sum.in");
  bench.connect("sum", "gain");
  bench.connect("gain", "plant");
  bench.connect("plant", "sum.feedback");
  bench.connect("plant", "out");
  bench.duration(2.217);
  bench.check_identity();
}

TEST_CASE("identity: a loop with a long delay, whose passes are several samples") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("sum", "streams.sum");
  bench.add("plant", "streams.pole", {{"pole", 0.9}, {"delay", std::int64_t{12}}});
  bench.connect("noise", "sum.in");
  bench.connect("sum", "plant");
  bench.connect("plant", "sum.feedback");
  bench.duration(1.217);
  bench.check_identity();
}

TEST_CASE("identity: a 10 kHz / 1 kHz cascaded loop") {
  Bench bench;
  bench.add("reference", "streams.noise", {{"rate", 1000.0}});
  bench.add("outer_error", "streams.sum");
  bench.add("outer", "streams.pole", {{"pole", 0.2}});
  bench.add("hold", "streams.hold", {{"factor", std::int64_t{10}}});
  bench.add("inner_error", "streams.sum");
  bench.add("inner", "streams.pole", {{"pole", 0.1}});
  bench.add("current", "streams.pole", {{"pole", 0.5}, {"delay", std::int64_t{1}}});
  bench.add("speed", "streams.pole", {{"pole", 0.99}, {"delay", std::int64_t{1}}});
  bench.add("scale", "streams.gain", {{"gain", 0.01}});
  bench.add("slow", "streams.decimate", {{"factor", std::int64_t{10}}});
  bench.add("sampled", "streams.pole", {{"pole", 0.0}, {"delay", std::int64_t{1}}});
  bench.connect("reference", "outer_error.in");
  bench.connect("sampled", "outer_error.feedback");
  bench.connect("outer_error", "outer");
  bench.connect("outer", "hold");
  bench.connect("hold", "inner_error.in");
  bench.connect("current", "inner_error.feedback");
  bench.connect("inner_error", "inner");
  bench.connect("inner", "current");
  bench.connect("current", "speed");
  bench.connect("speed", "scale");
  bench.connect("scale", "slow");
  bench.connect("slow", "sampled");
  bench.duration(0.417);
  bench.check_identity();
}

TEST_CASE("identity: live changes, records between rates, and an asynchronous block in a loop of records") {
  Bench bench;
  bench.add("noise", "streams.noise");
  bench.add("gain", "streams.gain");
  bench.add("frame", "messages.frame", {{"length", std::int64_t{64}}});
  bench.add("slow", "messages.slow_relay", {{"factor", 0.5}});
  bench.add("tuner", "messages.tuner", {{"parameter", std::string("gain")}});
  bench.add("pulse", "messages.pulse", {{"rate", 30.0}});
  bench.add("latch", "messages.latch");
  bench.add("relay", "messages.relay");
  bench.connect("noise", "gain");
  bench.connect("gain", "frame");
  bench.connect("gain", "latch");
  bench.tell("frame", "slow");
  bench.tell("slow", "tuner", after(1, 10));
  bench.tell("tuner", "gain.parameters", after_samples(3));
  bench.tell("pulse", "latch.first", after(1, 7));
  bench.tell("slow", "latch.second", after(1, 10));
  bench.tell("pulse", "relay");
  bench.tell("slow", "relay", after(1, 30));
  bench.schedule(0.5, "gain", "offset", 0.125);
  bench.schedule(0.7771, "latch", "scale", 2.0);
  bench.schedule(1.0, "slow", "factor", 0.25);
  bench.duration(1.7);
  const Result result = bench.run();
  CHECK(result.changes.at("gain").size() > 20);
  CHECK(result.records.at("relay.out").size() > 70);
  bench.check_identity();
}

TEST_CASE("identity: sources that end early in the middle of everything") {
  Bench bench;
  bench.add("short", "streams.counter", {{"ends", std::int64_t{777}}});
  bench.add("pulse", "messages.pulse", {{"rate", 70.0}});
  bench.add("latch", "messages.latch");
  bench.add("frame", "messages.frame", {{"length", std::int64_t{37}}, {"closing", true}});
  bench.add("slow", "messages.slow_relay");
  bench.add("noise", "streams.noise");
  bench.add("watch", "messages.latch");
  bench.connect("short", "latch");
  bench.connect("latch", "frame");
  bench.connect("noise", "watch");
  bench.tell("pulse", "latch.first");
  bench.tell("frame", "slow", after(1, 100));
  bench.tell("slow", "watch.second", after(1, 50));
  bench.duration(1.5);
  bench.check_identity();
}

}  // namespace
}  // namespace bodeflow::test
