#include "catch.hpp"
#include "lab/split.hpp"

namespace bodeflow::test {
namespace {

TEST_CASE("part: one that begins at a period has what is left of its blocks, streams and schedule") {
  lab::Part part;
  part.facts.period = Rate(1, 10);
  plan::Facts::Block block;
  block.repetitions = 3;  // 30 Hz
  block.firings = 3000;
  block.inputs.resize(2);
  block.input_flows.resize(2);
  block.input_flows[0].samples = 4;
  block.inputs[0].length = 12000;
  block.inputs[1].length = -1;
  block.outputs.resize(1);
  block.output_flows.resize(1);
  block.outputs[0].length = 70;
  part.facts.blocks.push_back(block);
  part.phase.schedule.resize(3);
  part.phase.schedule[0].time_s = 2.0;
  part.phase.schedule[1].time_s = 3.1;
  part.phase.schedule[2].time_s = 99.7;

  const Rate end = lab::begin_part_at(part, Rate(100, 1), 30);
  CHECK(end.num == 97);
  CHECK(end.den == 1);
  const plan::Facts::Block& left = part.facts.blocks.front();
  CHECK(left.firings == 3000 - 90);
  CHECK(left.inputs[0].length == 12000 - 360);
  CHECK(left.inputs[1].length == -1);
  CHECK(left.outputs[0].length == 0);
  CHECK(part.phase.schedule[0].time_s == 0.0);
  INFO("3.1 - 3 is a tenth, not the double that is left of it");
  CHECK(part.phase.schedule[1].time_s == 0.1);
  CHECK(part.phase.schedule[2].time_s == 96.7);
}

TEST_CASE("part: one that begins behind the run's end has nothing left") {
  lab::Part part;
  part.facts.period = Rate(1, 3);
  CHECK(lab::begin_part_at(part, Rate(5, 1), 16).num == 0);
}

}  // namespace
}  // namespace bodeflow::test
