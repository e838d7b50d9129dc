#include "register_value.hpp"

#include <cmath>
#include <limits>

#include "catch.hpp"

using namespace bodeflow::drive::modbus;

namespace {

Register as(Encoding encoding, double scale = 1.0, WordOrder order = WordOrder::high_first) {
  Register r;
  r.name = "speed";
  r.unit = "rpm";
  r.address = 0x32;
  r.encoding = encoding;
  r.scale = scale;
  r.order = order;
  return r;
}

}  // namespace

TEST_CASE("registers are read as two's complement of one or two words in either order times the scale") {
  const std::uint16_t words[] = {0xFFFE, 0x0001};
  CHECK(decoded(as(Encoding::uint16), words) == 65534.0);
  CHECK(decoded(as(Encoding::int16), words) == -2.0);
  CHECK(decoded(as(Encoding::int16, 0.5), words) == -1.0);
  CHECK(decoded(as(Encoding::uint32), words) == 4294836225.0);
  CHECK(decoded(as(Encoding::int32), words) == -131071.0);
  CHECK(decoded(as(Encoding::int32, 1.0, WordOrder::low_first), words) == 131070.0);
}

TEST_CASE("a float32 in two registers has its high word first or last") {
  const struct {
    double number;
    std::uint16_t high, low;
  } kNumbers[] = {{1.0, 0x3F80, 0x0000}, {-1234.5, 0xC49A, 0x5000}, {123456.0, 0x47F1, 0x2000}, {0.0, 0, 0}};
  for (const auto& [number, high, low] : kNumbers) {
    const std::uint16_t big[] = {high, low}, small[] = {low, high};
    CHECK(decoded(as(Encoding::float32), big) == number);
    CHECK(decoded(as(Encoding::float32, 1.0, WordOrder::low_first), small) == number);
    CHECK(*encoded(as(Encoding::float32), number) == std::array<std::uint16_t, 2>{high, low});
    CHECK(*encoded(as(Encoding::float32, 1.0, WordOrder::low_first), number) == std::array<std::uint16_t, 2>{low, high});
  }
}

TEST_CASE("a value that is written comes back rounded to the scale for every type and word order") {
  for (const Encoding encoding : {Encoding::int16, Encoding::int32, Encoding::float32}) {
    for (const WordOrder order : {WordOrder::high_first, WordOrder::low_first}) {
      const Register r = as(encoding, 0.1, order);
      for (const double value : {0.0, -0.1, 1499.9, -1500.0}) {
        const auto words = encoded(r, value);
        REQUIRE(words);
        CHECK(decoded(r, words->data()) == Approx(value).margin(1e-4));
      }
    }
  }
  CHECK(decoded(as(Encoding::int16, -0.1), encoded(as(Encoding::int16, -0.1), 12.34)->data()) == Approx(12.3));
}

TEST_CASE("a value beyond its register and one that is no number are refused by name") {
  CHECK(encoded(as(Encoding::int16, 0.1), 4000.0).error().text ==
        "speed (holding register 0x0032) is to be 4000 rpm, allowed as int16: -3276.8 to 3276.7 rpm");
  CHECK(encoded(as(Encoding::int16, 0.1), 3276.74).has_value());
  CHECK_FALSE(encoded(as(Encoding::uint32), -1.0).has_value());
  CHECK_FALSE(encoded(as(Encoding::float32), 1e39).has_value());
  CHECK(encoded(as(Encoding::float32), std::nan("")).error().text ==
        "speed (holding register 0x0032) is to be nan, allowed: finite numbers");
  CHECK_FALSE(encoded(as(Encoding::int32), std::numeric_limits<double>::infinity()).has_value());
}
