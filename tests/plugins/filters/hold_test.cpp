#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::Rate;
using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::Stream;

TEST_CASE("hold repeats each sample at a higher rate") {
  Stream x = Stream::with({{1, 2}, {3, 4}}, {250, 3});
  x.facts.length = 2;
  x.facts.unit = "V";
  LoadedBlock block("filters.hold");
  block.set("factor", std::int64_t{3}).feed({x}).start();
  const auto& facts = block.resolve()[0];
  CHECK(facts.rate == Rate(250, 1));
  CHECK(facts.length == 6);
  CHECK(facts.unit == "V");
  CHECK(block.output_flows()[0].samples == 3);
  CHECK(block.run(2, 1) == Channels{{1, 1, 1, 2, 2, 2}, {3, 3, 3, 4, 4, 4}});
}

TEST_CASE("hold repeats complex samples") {
  Stream x = Stream::of(std::vector<double>{1, 2, 3, 4});
  x.facts.element = BF_C64;
  LoadedBlock block("filters.hold");
  block.set("factor", std::int64_t{2}).feed({x}).start();
  CHECK(block.run(2) == Channels{{1, 2, 1, 2, 3, 4, 3, 4}});
}
