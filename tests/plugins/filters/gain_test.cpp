#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::Stream;

TEST_CASE("gain multiplies every channel, in its own memory or in the input's") {
  for (const bool share : {false, true}) {
    LoadedBlock block("filters.gain");
    block.set("gain", -2.5).feed({Stream::with({{1, 2, 3}, {10, 20, 30}})}).start();
    CHECK(block.run(3, 2, share) == Channels{{-2.5, -5, -7.5}, {-25, -50, -75}});
  }
}

TEST_CASE("gain multiplies complex samples") {
  Stream x = Stream::of(std::vector<double>{1, 2, 3, 4});
  x.facts.element = BF_C64;
  LoadedBlock block("filters.gain");
  block.set("gain", 2.0).feed({x}).start();
  CHECK(block.resolve()[0].element == BF_C64);
  CHECK(block.run(2) == Channels{{2, 4, 6, 8}});
}

TEST_CASE("gain changes between samples and goes back with reset") {
  LoadedBlock block("filters.gain");
  block.set("gain", 2.0).feed({Stream::of(std::vector<double>{1, 1, 1, 1})}).start();
  CHECK(block.run(2) == Channels{{2, 2}});
  block.change("gain", 3.0);
  CHECK(block.run(2) == Channels{{3, 3}});
  block.reset();
  CHECK(block.run(2) == Channels{{2, 2}});
}

TEST_CASE("gain keeps the unit of its input or gives its own") {
  Stream x = Stream::of(std::vector<double>{1});
  x.facts.unit = "A";
  LoadedBlock same("filters.gain");
  same.feed({x}).start();
  CHECK(same.resolve()[0].unit == "A");
  LoadedBlock sensor("filters.gain");
  sensor.feed({x}).set("unit", "V").start();
  CHECK(sensor.resolve()[0].unit == "V");
}
