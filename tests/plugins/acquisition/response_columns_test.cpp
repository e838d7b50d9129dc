#include "acquisition/response_columns.hpp"

#include <cmath>

#include "response_text.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::check_near;

namespace {

Expected<ResponseTable, TextError> read(const std::string& text, LoudspeakerFile kind) {
  return read_loudspeaker_file(*open_memory(text), kind);
}

ResponseTable table_of(const std::string& text, LoudspeakerFile kind = LoudspeakerFile::frd) {
  auto table = read(text, kind);
  INFO(test::message_of(table));
  REQUIRE(table);
  return *table;
}

}  // namespace

TEST_CASE("frd and zma: the magnitude is in dB in the one and in ohm in the other, the phase in degrees") {
  const auto frd = table_of("10 20 90\n20 0 0\n");
  CHECK(frd.frequency_hz == std::vector<double>{10.0, 20.0});
  check_near(frd.elements[0].value[0], {0.0, 10.0});
  check_near(frd.elements[0].value[1], {1.0, 0.0});
  CHECK(frd.elements[0].unit == "");
  CHECK(frd.remarks == std::vector<std::string>{"the file does not say what 0 dB is"});
  const auto zma = table_of("10 8 -60\n", LoudspeakerFile::zma);
  check_near(zma.elements[0].value[0], std::polar(8.0, -M_PI / 3));
  CHECK(zma.elements[0].unit == "ohm");
  CHECK(zma.elements[0].quantity == "Z");
}

TEST_CASE("frd and zma: blanks, tabs, semicolons, commas and decimal commas separate the same numbers") {
  for (const char* text : {"10.5 6.02 -45\n", "10.5\t6.02\t-45\r\n", "10.5;6.02;-45\n", "10.5,6.02,-45\n", "10.5, 6.02, -45\n",
                           "  +1.05e1 6.02   -45.0\n", "10,5 6,02 -45\n", "10,5;6,02;-45\n"}) {
    INFO(text);
    const auto t = table_of(text);
    CHECK(t.frequency_hz == std::vector<double>{10.5});
    check_near(t.elements[0].value[0], std::polar(std::pow(10.0, 6.02 / 20), -M_PI / 4));
  }
}

TEST_CASE("frd and zma: comments and the lines of text before the first point are passed over and told") {
  const auto t = table_of("* Room EQ\n; x\n\"quoted\"\nFreq(Hz) SPL(dB) Phase(deg)\n\n10 0 0\n! inside\n20 0 0\n");
  CHECK(t.frequency_hz.size() == 2);
  CHECK(t.remarks == std::vector<std::string>{"the file does not say what 0 dB is", "4 comment lines passed over",
                                              "1 line of text before the first point passed over"});
}

TEST_CASE("frd and zma: phases that look like radians are told") {
  std::string text;
  for (int k = 0; k < 20; ++k) text += std::to_string(10 + k) + " 0 " + std::to_string(3.1 * std::sin(0.7 * k)) + "\n";
  CHECK(table_of(text).warnings == std::vector<std::string>{"phase: all phases lie within +-3.06332 deg: are they radians?"});
  CHECK(table_of(text + "50 0 -170\n").warnings.empty());
}

TEST_CASE("frd and zma: each kind of broken file is refused with its place and reason") {
  using namespace std::string_literals;
  const std::vector<test::BrokenResponse> cases = {
      {"empty file", "", "F: empty file"},
      {"text alone", "no numbers\nhere\n", "F: no points: no line begins with a number"},
      {"comments alone", "* a\n", "F: no points: no line begins with a number"},
      {"no phase", "10 80\n20 81\n",
       "F:1: 2 numbers: a response needs frequency, magnitude and phase [deg]; here the phase is missing"},
      {"one number", "10 0 0\n20\n", "F:2: 1 number; 3 a line: frequency [Hz], magnitude, phase [deg]"},
      {"four numbers", "10 0 0 1\n", "F:1:8: 4 numbers; 3 a line: frequency [Hz], magnitude, phase [deg]"},
      {"text behind the first point", "10 0 0\nend of file\n", "F:2:1: 'end' is not a number"},
      {"text in a point", "10 0 0\n20 abc 0\n", "F:2:4: 'abc' is not a number"},
      {"not finite", "10 inf 0\n", "F:1:4: 'inf' is not finite"},
      {"beyond a double", "10 1e999 0\n", "F:1:4: '1e999' is beyond the range of a double"},
      {"decibels beyond a double", "10 7000 0\n", "F:1:4: 7000 dB is beyond the range of a double"},
      {"frequencies that fall", "10 0 0\n5 0 0\n", "F:2:1: frequencies do not rise: 5 Hz after 10 Hz in line 1"},
      {"point twice", "10 0 0\n\n10 0 0\n", "F:3:1: point at 10 Hz stands twice: it is in line 1 too"},
      {"negative frequency", "-10 0 0\n", "F:1:1: frequency -10 Hz; at least 0"},
      {"decimal comma after points", "10.5 0.1 0\n20,5 0,1 0\n",
       "F:2:8: 5 numbers; 3 a line: frequency [Hz], magnitude, phase [deg]"},
      {"NUL byte", "10 0 0\n\0\n"s, "F:2:1: NUL byte: this is no text, or the file is damaged"},
      {"UTF-16", "\xFF\xFE"s + "1\n", "F:1:1: UTF-16 text; save the file as UTF-8"},
      {"lone carriage returns", "10 0 0\r20 0 0\r", "F:1:7: carriage return inside a line; lines end with LF or CRLF"},
      {"unit behind the number", "10Hz 0 0\n", "F:1:1: '10Hz' is not a number"},
  };
  for (const auto& c : cases) {
    INFO(c.what);
    CHECK(test::message_of(read(c.text, LoudspeakerFile::frd)) == c.message);
  }
  CHECK(test::message_of(read("10 -8 0\n", LoudspeakerFile::zma)) == "F:1:4: impedance -8 ohm; at least 0");
}
