#include "static_nonlinearity.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "catch.hpp"
#include "plugins/loaded_block.hpp"

using bodeflow::test::Channels;
using bodeflow::test::LoadedBlock;
using bodeflow::test::Stream;

TEST_CASE("static nonlinearity: the polynomial has the values of its powers, and limits are kept") {
  const std::vector<double> c{0.5, -2.0, 0.0, 3.0};
  for (const double x : {-2.0, -0.3, 0.0, 1.0, 7.0}) {
    CHECK(bodeflow::filters::polynomial(c, x) == Approx(0.5 - 2.0 * x + 3.0 * x * x * x).epsilon(1e-14));
  }
  CHECK(bodeflow::filters::polynomial({}, 3.0) == 0.0);
  CHECK(bodeflow::filters::limited(3.0, -1.0, 2.0) == 2.0);
  CHECK(bodeflow::filters::limited(-3.0, -1.0, 2.0) == -1.0);
  CHECK(bodeflow::filters::limited(0.3, -1.0, 2.0) == 0.3);
  CHECK(std::isnan(bodeflow::filters::limited(std::numeric_limits<double>::quiet_NaN(), -1.0, 2.0)));
}

TEST_CASE("static nonlinearity: every channel, in its own memory or in the input's") {
  for (const bool share : {false, true}) {
    LoadedBlock block("filters.static_nonlinearity");
    block.set("coefficients", std::vector<double>{1.0, 0.0, 2.0})
        .set("greatest", 10.0)
        .feed({Stream::with({{1, 2, 3}, {0, -1, -2}})})
        .start();
    CHECK(block.run(3, 2, share) == Channels{{3, 9, 10}, {1, 3, 9}});
  }
}

TEST_CASE("static nonlinearity: the unit is the input's or its own, and only what stays true is noted") {
  Stream x = Stream::of(std::vector<double>{1});
  x.facts.unit = "A";
  x.facts.notes["excitation.period"] = {0.5};
  x.facts.notes["noise.std"] = {0.1};
  x.facts.notes["excitation.amplitudes"] = {1.0};
  LoadedBlock block("filters.static_nonlinearity");
  block.feed({x}).set("unit", "V").start();
  const auto out = block.resolve()[0];
  CHECK(out.unit == "V");
  CHECK(out.notes.count("excitation.period") == 1);
  CHECK(out.notes.count("noise.std") == 0);
  CHECK(out.notes.count("excitation.amplitudes") == 0);
}

TEST_CASE("static nonlinearity: limits that leave nothing are refused") {
  LoadedBlock block("filters.static_nonlinearity");
  block.set("least", 2.0).set("greatest", 1.0).feed({Stream::of(std::vector<double>{1})});
  std::string refusal;
  try {
    block.start();
  } catch (const bodeflow::Failure& f) {
    refusal = f.what();
  }
  CHECK(refusal == "least 2 is above greatest 1");
}
