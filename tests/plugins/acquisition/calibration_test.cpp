#include "acquisition/device/calibration.hpp"

#include "acquisition/number_line.hpp"
#include "catch.hpp"

using namespace bodeflow::acquisition;

namespace {

std::string refusal(const std::string& text) {
  const auto source = open_memory(text);
  const auto rows = read_calibration(*source);
  return rows ? "no refusal" : text_at("cal.csv", rows.error());
}

}  // namespace

TEST_CASE("calibration: columns stand in any order and offset and unit may be left out") {
  const std::string text = "\xEF\xBB\xBF# bench\nunit;gain;channel;note\r\nV;2.5;\"left; outer\";x\r\n;-1e-3;right;y\r\n";
  const auto source = open_memory(text);
  const auto rows = read_calibration(*source);
  REQUIRE(rows);
  REQUIRE(rows->size() == 2);
  CHECK((*rows)[0].channel == "left; outer");
  CHECK((*rows)[0].scale.gain == 2.5);
  CHECK((*rows)[0].scale.offset == 0.0);
  CHECK((*rows)[0].scale.unit == "V");
  CHECK((*rows)[1].scale.gain == -1e-3);
  const auto scales = scales_of(*rows, {"right"});
  REQUIRE(scales);
  CHECK(scales->front().gain == -1e-3);
  CHECK(scales_of(*rows, {"rihgt"}).error().text == "no row for channel 'rihgt'; it has left; outer, right");
}

TEST_CASE("calibration: what is wrong is refused with its place") {
  CHECK(refusal("") == "cal.csv: empty; needed: a header and a row for each channel");
  CHECK(refusal("channel,gain\n") == "cal.csv: no channel below the header");
  CHECK(refusal("name,gain\n") == "cal.csv:1:1: no column 'channel'; the header names channel, gain, offset, unit");
  CHECK(refusal("channel,gain,gain\n") == "cal.csv:1:14: column 'gain' stands twice");
  CHECK(refusal("channel,gain\na,1,2\n") == "cal.csv:2:1: 3 fields; the header has 2");
  CHECK(refusal("channel,gain\n,1\n") == "cal.csv:2:1: a row without the name of its channel");
  CHECK(refusal("channel,gain\na,1\n\na,2\n") == "cal.csv:4:1: channel 'a' stands twice");
  CHECK(refusal("channel,gain\na,x\n") == "cal.csv:2:3: column 'gain': 'x' is not a number");
  CHECK(refusal("channel,gain,offset\na,1,nan\n") == "cal.csv:2:5: column 'offset': 'nan' is not finite");
  CHECK(refusal("channel,gain\na,0\n") == "cal.csv:2:3: a gain of 0; allowed: any other number");
  CHECK(refusal("channel,gain,unit\na,1,volts\n") == "cal.csv:2:5: 'volts' is not a unit");
}
