#include "records/band.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "catch.hpp"
#include "records/checksum.hpp"

using bodeflow::records::Checksum;
using bodeflow::records::parse_band;
constexpr double kPi = std::numbers::pi;

TEST_CASE("band: bare numbers are radians per sample, others have their unit, and a unit serves both ends") {
  const auto bare = parse_band("0:0.625", 1000.0);
  REQUIRE(bare);
  CHECK(bare->low_rad_s == 0.0);
  CHECK(bare->high_rad_s == Approx(625.0));
  CHECK(parse_band("0.1:0.2 rad/sample", 10.0)->high_rad_s == Approx(2.0));
  CHECK(parse_band("1:50 Hz", 1000.0)->low_rad_s == Approx(2.0 * kPi));
  CHECK(parse_band("10 rad/s:50 Hz", 1000.0)->low_rad_s == Approx(10.0));
  CHECK(parse_band("500 mHz : 1 kHz", 0.0)->high_rad_s == Approx(2000.0 * kPi));
}

TEST_CASE("band: an open end reaches zero or half the sample rate, and an empty text is the whole range") {
  CHECK(parse_band(":20 Hz", 100.0)->low_rad_s == 0.0);
  CHECK(parse_band("20 Hz:", 100.0)->high_rad_s == Approx(100.0 * kPi));
  CHECK(parse_band("", 100.0)->high_rad_s == Approx(100.0 * kPi));
  CHECK(parse_band("1 Hz:", 0.0)->high_rad_s == std::numeric_limits<double>::infinity());
  CHECK(parse_band("0:3.14159265359", 1.0));
}

TEST_CASE("band: what is no band is refused with its text") {
  const auto reason = [](const char* text, double rate) { return parse_band(text, rate).error().text; };
  CHECK(reason("5", 1.0) == "band '5': allowed: two ends with a colon between, such as 0:0.625 or 1 Hz:50 Hz");
  CHECK(reason("0:4", 1.0) == "band '0:4': the upper end is above half the sample rate (0.5 Hz)");
  CHECK(reason("2:1 Hz", 100.0) == "band '2:1 Hz': the ends must rise from 0 on");
  CHECK(reason("-1:1 Hz", 100.0) == "band '-1:1 Hz': the ends must rise from 0 on");
  CHECK(reason("1:2", 0.0) == "band '1:2': '1' has no unit; needed here: Hz or rad/s");
  CHECK(reason("1:2 V", 100.0) == "band '1:2 V': '1 V' is no frequency; allowed: numbers in rad/sample, or with Hz or rad/s");
  CHECK_FALSE(parse_band("nan:1 Hz", 100.0));
  CHECK_FALSE(parse_band("a:b", 100.0));
  CHECK_FALSE(parse_band("1:2:3", 100.0));
}

TEST_CASE("checksum: FNV-1a of the bytes, the same for one call or several, another for another order") {
  Checksum empty;
  CHECK(empty.text() == "cbf29ce484222325");
  const std::array<double, 3> values{1.0, -2.5, 3e-300};
  Checksum whole, parts, turned;
  whole.add(values);
  parts.add(std::span(values).first(1));
  parts.add(std::span(values).last(2));
  CHECK(whole.text() == parts.text());
  turned.add(std::array<double, 3>{-2.5, 1.0, 3e-300});
  CHECK(whole.text() != turned.text());
  Checksum zeros;  // eight bytes of zero: the offset basis times the prime to the eighth power
  zeros.add(std::array<double, 1>{0.0});
  std::uint64_t expected = 0xcbf29ce484222325u;
  for (int i = 0; i < 8; ++i) expected *= 0x100000001b3u;
  CHECK(std::stoull(zeros.text(), nullptr, 16) == expected);
}
