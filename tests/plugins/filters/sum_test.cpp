#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::refusal_of;
using bodeflow::test::Stream;

namespace {

Stream in_unit(const char* unit) {
  Stream x = Stream::of(std::vector<double>{1});
  x.facts.unit = unit;
  return x;
}

std::string refused(std::vector<Stream> inputs) {
  LoadedBlock block("filters.sum");
  block.feed(std::move(inputs)).configure();
  return refusal_of([&] { block.resolve(); });
}

}  // namespace

TEST_CASE("sum of two inputs with weights 1 and -1 is their difference, also in the first input's memory") {
  for (const bool share : {false, true}) {
    LoadedBlock block("filters.sum");
    block.set("weights", std::vector<double>{1, -1})
        .feed({Stream::with({{5, 6}, {7, 8}}), Stream::with({{1, 2}, {3, 5}})})
        .start();
    CHECK(block.run(2, 1, share) == Channels{{4, 4}, {4, 3}});
  }
}

TEST_CASE("sum takes up to four inputs, with weight 1 where none is given") {
  LoadedBlock block("filters.sum");
  block.set("weights", std::vector<double>{2, 3, 4});
  block.feed({Stream::of({1}), Stream::of({10}), Stream::of({100}), Stream::of({1000})}).start();
  CHECK(block.run(1) == Channels{{2 + 30 + 400 + 1000}});
}

TEST_CASE("sum adds complex samples") {
  Stream x = Stream::of(std::vector<double>{1, 2, 3, 4});
  x.facts.element = BF_C64;
  LoadedBlock block("filters.sum");
  block.set("weights", std::vector<double>{1, 0.5}).feed({x, x}).start();
  CHECK(block.run(2) == Channels{{1.5, 3, 4.5, 6}});
}

TEST_CASE("sum knows its output as soon as one input is known, so that a loop through it resolves") {
  LoadedBlock block("filters.sum");
  block.feed({in_unit("V"), Stream()}).configure();
  CHECK(block.resolve()[0].known);
  CHECK(block.resolve()[0].unit == "V");
  LoadedBlock none("filters.sum");
  none.feed({Stream(), Stream()}).configure();
  CHECK_FALSE(none.resolve()[0].known);
}

TEST_CASE("sum ends with its shortest input and takes the unit of the first input that has one") {
  Stream x = in_unit("");
  x.facts.length = 10;
  Stream y = in_unit("Nm");
  y.facts.length = 7;
  LoadedBlock block("filters.sum");
  block.feed({x, y}).configure();
  CHECK(block.resolve()[0].length == 7);
  CHECK(block.resolve()[0].unit == "Nm");
}

TEST_CASE("sum refuses inputs that do not go together") {
  CHECK(refused({in_unit("V"), in_unit("A")}) == "inputs 'a' and 'b' are in V and A; allowed: the same unit");
  CHECK(refused({in_unit("V"), in_unit("mV")}) == "inputs 'a' and 'b' are in V and mV; allowed: the same unit");
  CHECK(refused({Stream::of({1}), Stream::with({{1}, {2}})}) ==
        "inputs 'a' and 'b' have 1 and 2 channels; allowed: the same number");
  Stream complex = in_unit("V");
  complex.facts.element = BF_C64;
  CHECK(refused({in_unit("V"), in_unit("V"), complex}) == "inputs 'a' and 'c' are not both real or both complex");
  LoadedBlock block("filters.sum");
  block.set("weights", std::vector<double>(5));
  CHECK(refusal_of([&] { block.configure(); }) == "weights has 5 values, allowed: at most 4");
}
