#include "records/record_copy.hpp"

#include <complex>

#include "catch.hpp"
#include "plugins/spectrum/record_bytes.hpp"

using namespace bodeflow;

TEST_CASE("copy of a record: the same bytes, to be completed") {
  RecordBuilder original("trace");
  original.set("verdict", "named").set("right", true).set("count", std::int64_t{3}).set("share", 0.5);
  original.set("names", std::vector<std::string>{"a", "b"}).set("none", std::vector<std::string>{});
  original.set("counts", std::vector<std::int64_t>{1, 2}).set("flags", std::vector<bool>{true, false});
  original.array<double>("values", "V", {2, 2})[3] = 1.5;
  original.array<std::complex<double>>("response", "A/V", {1})[0] = {1, -2};
  original.array<std::int64_t>("kind", "", {3})[1] = 7;
  original.array<std::uint8_t>("bytes", "", {5})[4] = 9;
  const test::AlignedRecord bytes(original);
  RecordBuilder copy = records::copy_of(bytes.view());
  CHECK(copy.bytes() == original.bytes());
  copy.set("share", 0.75);
  CHECK(copy.bytes() != original.bytes());
}
