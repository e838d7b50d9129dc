#include "net.hpp"

using namespace bodeflow;
using namespace bodeflow::test;

namespace {

constexpr std::uint64_t kChunkBytes = 1024 * sizeof(double);

/// A source and 16 gains in a row.
Net chain() {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("b0", {1000, 1});
  for (int i = 1; i <= 16; ++i) {
    net.gain("b" + std::to_string(i));
    net.connect("b" + std::to_string(i - 1), "b" + std::to_string(i));
  }
  return net;
}

}  // namespace

TEST_CASE("buffers: a chain needs the memory of two") { CHECK(chain().plan(1024).bytes == 2 * kChunkBytes); }

TEST_CASE("buffers: a chain of in-place blocks needs the memory of one") {
  Net net = chain();
  for (int i = 1; i <= 16; ++i) net.type(i).in_place = true;
  CHECK(net.plan(1024).bytes == kChunkBytes);
}

TEST_CASE("buffers: recorded outputs keep their memory to the end of the chunk") {
  Net net = chain();
  plan::PlanOptions options;
  options.kept = {{3, 0}, {7, 0}};
  CHECK(net.plan(options).bytes == 4 * kChunkBytes);
  for (int i = 1; i <= 16; ++i) net.type(i).in_place = true;
  CHECK(net.plan(options).bytes == 3 * kChunkBytes);
}

TEST_CASE("buffers: an in-place block does not write over an input that others still read") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1});
  net.gain("b");
  net.gain("c");
  net.type(1).in_place = true;
  net.type(2).in_place = true;
  net.connect("a", "b");
  net.connect("a", "c");
  const plan::Plan plan = net.plan(1024);
  CHECK(plan.buffers[1].arena_offset != plan.buffers[0].arena_offset);
  CHECK(plan.buffers[2].arena_offset == plan.buffers[0].arena_offset);
}

TEST_CASE("buffers: an in-place block that reads one stream twice, or one of other size, gets memory of its own") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1});
  net.sum("twice");
  net.hold("hold", 2);
  net.type(1).in_place = true;
  net.type(2).in_place = true;
  net.connect("a", "twice.in");
  net.connect("a", "twice.feedback");
  net.connect("twice", "hold");
  const plan::Plan plan = net.plan(1024);
  CHECK(plan.buffers[0].arena_offset != plan.buffers[1].arena_offset);
  CHECK(plan.buffers[1].arena_offset != plan.buffers[2].arena_offset);
}

TEST_CASE("buffers: channels are padded to 64 bytes, and unconnected outputs have room as well") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1}, -1, 3);
  const plan::Plan plan = net.plan(5);
  CHECK(plan.buffers[0].capacity == 5);
  CHECK(plan.buffers[0].bytes == 3 * 64);
  CHECK(plan.bytes == 3 * 64);
}

TEST_CASE("buffers: readers with delays share one history, each from its own place") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1}, -1, 2);
  net.lag("b", 3, {1.0, 2.0, 3.0, 10.0, 20.0, 30.0});
  net.lag("c", 1, {3.0, 30.0});
  net.gain("d");
  net.connect("a", "d");
  net.connect("a", "c");
  net.connect("a", "b");
  const plan::Plan plan = net.plan(64);
  REQUIRE(plan.buffers.size() == 4);
  CHECK(plan.buffers[0].history == 3);
  CHECK(plan.initial[0] == std::vector<double>{1.0, 2.0, 3.0, 10.0, 20.0, 30.0});
  for (int reader = 1; reader <= 3; ++reader) CHECK(plan.inputs[static_cast<std::size_t>(reader)][0].buffer == 0);
  CHECK(plan.inputs[1][0].delay == 3);
  CHECK(plan.inputs[2][0].delay == 1);
  CHECK(plan.inputs[3][0].delay == 0);
}

TEST_CASE("buffers: complex initial values count in pairs, and missing ones are zeros") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.add("a", {}, {"out"}, [](const auto&) {
    Resolution r{{stream({1000, 1})}, {}, {Flow{}}};
    r.outputs[0].element = BF_C64;
    return r;
  });
  net.lag("b", 2, {1.0, -1.0, 0.0, 0.0});
  net.lag("c", 1);
  net.connect("a", "b");
  net.connect("a", "c");
  const plan::Plan plan = net.plan(4);
  CHECK(plan.inputs[2][0].buffer == 0);
  CHECK(plan.initial[0] == std::vector<double>{1.0, -1.0, 0.0, 0.0});
  CHECK(plan.buffers[0].bytes == 128);  // 2 + 4 samples of 16 bytes
}

TEST_CASE("buffers: a reader whose initial values differ gets a copy behind the writer") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("a", {1000, 1});
  net.lag("b", 2, {1.0, 2.0});
  net.lag("c", 1, {5.0});
  net.connect("a", "b");
  net.connect("a", "c");
  const plan::Plan plan = net.plan(64);
  REQUIRE(plan.buffers.size() == 4);
  CHECK(plan.inputs[1][0].buffer == 0);
  CHECK(plan.inputs[2][0].buffer == 3);
  CHECK(plan.initial[3] == std::vector<double>{5.0});
  const plan::Step& copy = plan.partitions[0].steps[1];
  CHECK(copy.kind == plan::Step::Kind::copy);
  CHECK(copy.from_buffer == 0);
  CHECK(copy.to_buffer == 3);
}

TEST_CASE("buffers: inside a loop the copy follows each firing of the writer") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {1000, 1});
  net.sum("sum");
  net.lag("plant", 1, {1.0});
  net.lag("model", 1, {2.0});
  net.sum("difference");
  net.connect("reference", "sum.in");
  net.connect("sum", "plant");
  net.connect("sum", "model");
  net.connect("plant", "difference.in");
  net.connect("model", "difference.feedback");
  net.connect("difference", "sum.feedback");
  const plan::Plan plan = net.plan(64);
  REQUIRE(plan.partitions[0].steps.size() == 2);
  CHECK(text_of(net.phase, plan.partitions[0].steps[1]) == "plant, model, difference, sum, sum copied");
  CHECK(plan.inputs[3][0].buffer == 5);
}

TEST_CASE("buffers: those inside a loop never share memory with each other") {
  Net net;
  net.phase.run.duration_s = 1.0;
  net.source("reference", {1000, 1});
  net.sum("sum");
  net.gain("p");
  net.gain("q");
  net.lag("plant");
  net.sink("sink");
  for (int i = 1; i <= 3; ++i) net.type(i).in_place = true;
  net.connect("reference", "sum.in");
  net.connect("sum", "p");
  net.connect("p", "q");
  net.connect("q", "plant");
  net.connect("plant", "sum.feedback");
  net.connect("plant", "sink");
  const plan::Plan plan = net.plan(1024);
  // reference, sum, p, plant: a chunk each; q has one sample of history in a padded line.
  CHECK(plan.bytes == 5 * kChunkBytes + 64);
}
