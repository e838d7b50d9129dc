#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

TEST_CASE("ends: a block ends with the shortest of its inputs, and passes that on") {
  Net net;
  net.source("long", {1000, 1}, 500);
  net.source("short", {1000, 1}, 105);
  net.sum("sum");
  net.decimate("tenth", 10);
  net.sink("sink");
  net.connect("long", "sum.in");
  net.connect("short", "sum.feedback");
  net.connect("sum", "tenth");
  net.connect("tenth", "sink");
  const plan::Facts facts = net.facts();
  CHECK(facts.blocks[0].firings == 500);
  CHECK(facts.blocks[2].firings == 105);
  CHECK(facts.blocks[2].outputs[0].length == 105);
  CHECK(facts.blocks[3].firings == 10);
  CHECK(facts.blocks[4].firings == 10);
  CHECK(facts.blocks[4].inputs[0].length == 10);
}

TEST_CASE("ends: run.duration gives whole firings on every block's own clock") {
  Net net;
  net.phase.run.duration_s = 0.0105;
  net.source("fast", {10000, 1});
  net.source("slow", {1000, 1}, 4000);
  const plan::Facts facts = net.facts();
  CHECK(facts.blocks[0].firings == 105);
  CHECK(facts.blocks[1].firings == 10);
}

TEST_CASE("ends: a loop over two rates ends where both of its rates have whole firings") {
  Net net;
  net.source("reference", {1000, 1}, 105);
  net.sum("sum");
  net.decimate("decimate", 10);
  net.lag("slow");
  net.hold("hold", 10);
  net.connect("reference", "sum.in");
  net.connect("sum", "decimate");
  net.connect("decimate", "slow");
  net.connect("slow", "hold");
  net.connect("hold", "sum.feedback");
  const plan::Facts facts = net.facts();
  CHECK(facts.blocks[1].firings == 100);
  CHECK(facts.blocks[2].firings == 10);
  CHECK(facts.blocks[4].firings == 10);
}

TEST_CASE("ends: endless sources without a duration are an error that says what to set") {
  Net net;
  net.source("noise", {1000, 1});
  net.source("file", {1000, 1}, 10);
  net.gain("a");
  net.connect("noise", "a");
  const auto facts = net.try_facts();
  REQUIRE_FALSE(facts);
  CHECK(to_string(facts.error()) == "g.yaml:1:3: the run has no end: nothing limits 'noise'; set run.duration");
}

TEST_CASE("ends: an endless source that feeds a block with an end stops with it") {
  Net net;
  net.source("noise", {3000, 1});
  net.decimate("third", 3);
  net.source("file", {1000, 1}, 10);
  net.sum("sum");
  net.connect("noise", "third");
  net.connect("third", "sum.in");
  net.connect("file", "sum.feedback");
  const plan::Facts facts = net.facts();
  CHECK(facts.blocks[3].firings == 10);
  CHECK(facts.blocks[1].firings == 10);
  CHECK(facts.blocks[0].firings == 30);
}

TEST_CASE("ends: a loop without any source has no end either") {
  Net net;
  net.add("oscillator", {"in"}, {"out"}, [](const auto&) { return Resolution{{stream({1000, 1})}, {{1, 1, {1.0}}}, {Flow{}}}; });
  net.connect("oscillator", "oscillator");
  const auto facts = net.try_facts();
  REQUIRE_FALSE(facts);
  CHECK(to_string(facts.error()) == "g.yaml:1:3: the run has no end: nothing limits 'oscillator'; set run.duration");
}

TEST_CASE("ends: a block that never fires is a warning") {
  Net net;
  net.source("file", {1000, 1}, 7);
  net.decimate("tenth", 10);
  net.connect("file", "tenth");
  CHECK(net.facts().warnings ==
        std::vector<std::string>{"block 'tenth' never fires: the run ends before its first 10 ms are over"});
}
