#include "filters/notes.hpp"

#include "catch.hpp"

using bodeflow::filters::added;
using bodeflow::filters::Notes;
using bodeflow::filters::scaled;

TEST_CASE("a gain scales amplitudes and noise, not frequencies") {
  const Notes notes = scaled({{"excitation.amplitudes", {1, 2}}, {"excitation.frequencies", {10, 20}}, {"noise.std", {0.5}}}, -3);
  CHECK(notes == Notes{{"excitation.amplitudes", {3, 6}}, {"excitation.frequencies", {10, 20}}, {"noise.std", {1.5}}});
}

TEST_CASE("noises add in power, an excitation that only one stream has is that of the sum") {
  const Notes a{{"excitation.period", {2}}, {"noise.std", {3}}}, b{{"noise.std", {4}}};
  CHECK(added(a, b) == Notes{{"excitation.period", {2}}, {"noise.std", {5}}});
  CHECK(added(b, a) == added(a, b));
}

TEST_CASE("two excitations of different period leave no period to the sum") {
  const Notes a{{"excitation.period", {2}}, {"excitation.frequencies", {1}}};
  const Notes b{{"excitation.period", {3}}, {"excitation.frequencies", {1}}};
  CHECK(added(a, b) == Notes{{"excitation.frequencies", {1}}});
}
