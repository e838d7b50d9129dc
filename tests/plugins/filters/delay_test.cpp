#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;
using bodeflow::test::Stream;

TEST_CASE("delay gives its initial values first, in order of time, then the input") {
  LoadedBlock block("filters.delay");
  block.set("samples", std::int64_t{2})
      .set("initial", std::vector<double>{7, 8})
      .feed({Stream::with({{1, 2, 3}, {4, 5, 6}})})
      .start();
  CHECK(block.input_flows()[0].delay == 2);
  CHECK(block.run(5, 2) == Channels{{7, 8, 1, 2, 3}, {7, 8, 4, 5, 6}});
}

TEST_CASE("one initial value stands for all, without one they are zero") {
  LoadedBlock same("filters.delay");
  same.set("samples", std::int64_t{3})
      .set("initial", std::vector<double>{9})
      .feed({Stream::of(std::vector<double>{1, 2})})
      .start();
  CHECK(same.run(5, 1, true) == Channels{{9, 9, 9, 1, 2}});
  LoadedBlock zero("filters.delay");
  zero.set("samples", std::int64_t{1}).feed({Stream::of(std::vector<double>{1, 2})}).start();
  CHECK(zero.run(3) == Channels{{0, 1, 2}});
}

TEST_CASE("delay of complex samples begins with real initial values") {
  Stream x = Stream::of(std::vector<double>{1, 2, 3, 4});
  x.facts.element = BF_C64;
  LoadedBlock block("filters.delay");
  block.set("samples", std::int64_t{1}).set("initial", std::vector<double>{5}).feed({x}).start();
  CHECK(block.run(3) == Channels{{5, 0, 1, 2, 3, 4}});
}

TEST_CASE("delay states its samples before its input is known, so that a loop can be planned") {
  LoadedBlock block("filters.delay");
  block.set("samples", std::int64_t{4}).set("initial", std::vector<double>{1}).feed({Stream()}).configure();
  CHECK_FALSE(block.resolve()[0].known);
  CHECK(block.input_flows()[0].delay == 4);
}

TEST_CASE("a wrong number of initial values is refused") {
  LoadedBlock block("filters.delay");
  block.set("samples", std::int64_t{4}).set("initial", std::vector<double>{1, 2});
  CHECK(refusal_of([&] { block.configure(); }) == "initial has 2 values, allowed: 1, or as many as the delay has samples (4)");
}
