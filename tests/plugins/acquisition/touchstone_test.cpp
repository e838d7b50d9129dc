#include "acquisition/touchstone.hpp"

#include <cmath>
#include <limits>

#include "response_text.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::check_near;

namespace {

Expected<ResponseTable, TextError> read(const std::string& text, int ports) { return read_touchstone(*open_memory(text), ports); }

ResponseTable table_of(const std::string& text, int ports) {
  auto table = read(text, ports);
  INFO(test::message_of(table));
  REQUIRE(table);
  return *table;
}

}  // namespace

TEST_CASE("Touchstone: units, forms and defaults of the option line are understood in any order and case") {
  const double third = std::cos(M_PI / 3);
  for (const char* options : {"# Hz S MA R 50", "# s ma hz", "#hz", "# r 50 HZ ma"}) {
    INFO(options);
    const auto t = table_of(std::string(options) + "\n100 2 60\n", 1);
    CHECK(t.frequency_hz == std::vector<double>{100.0});
    CHECK(t.format == "Touchstone 1, 1 port, S parameters, reference 50 ohm");
    check_near(t.elements[0].value[0], {2 * third, 2 * std::sin(M_PI / 3)});
    CHECK(t.elements[0].unit == "1");
  }
  CHECK(table_of("#\n1.5 1 0\n", 1).frequency_hz[0] == 1.5e9);
  CHECK(table_of("# kHz\n1.5 1 0\n", 1).frequency_hz[0] == 1500.0);
  CHECK(table_of("# MHZ\n1.5 1 0\n", 1).frequency_hz[0] == 1.5e6);
  check_near(table_of("# DB\n1 20 -90\n", 1).elements[0].value[0], {0.0, -10.0});
  check_near(table_of("# RI\n1 0.25 -0.5\n", 1).elements[0].value[0], {0.25, -0.5});
}

TEST_CASE("Touchstone: impedances and admittances of version 1 are normalised and come back in ohm and siemens") {
  const auto z = table_of("# Z RI R 75\n1 2 -4\n", 1);
  check_near(z.elements[0].value[0], {150.0, -300.0});
  CHECK(z.elements[0].unit == "ohm");
  CHECK(z.elements[0].quantity == "Z11");
  CHECK(z.remarks == std::vector<std::string>{"normalised to 75 ohm in the file, given back in ohm"});
  const auto y = table_of("# Y RI R 50\n1 2 -4\n", 1);
  check_near(y.elements[0].value[0], {0.04, -0.08});
  CHECK(y.elements[0].unit == "S");
}

TEST_CASE("Touchstone: two ports come column by column, three and more row by row over several lines") {
  const auto two = table_of("# RI\n1 11 0 21 0 12 0 22 0\n", 2);
  REQUIRE(two.elements.size() == 4);
  for (const ResponseElement& e : two.elements) {
    INFO(e.quantity);
    CHECK("S" + std::to_string(static_cast<int>(e.value[0].real())) == e.quantity);
    CHECK(e.output + e.input == std::string("b") + e.quantity[1] + "a" + e.quantity[2]);
  }
  CHECK(two.elements[1].quantity == "S21");
  const auto three = table_of(
      "# RI\n1 11 0 12 0 13 0 ! row 1\n 21 0 22 0 23 0\n\n 31 0 32 0 33 0\n2 1 1 1 1 1 1\n1 1 1 1 1 1\n1 1 1 1 1 1\n", 3);
  REQUIRE(three.frequency_hz.size() == 2);
  for (const ResponseElement& e : three.elements) CHECK("S" + std::to_string(static_cast<int>(e.value[0].real())) == e.quantity);
  CHECK(three.elements[3].quantity == "S21");
  const auto ten = table_of(
      "# RI\n" +
          [] {
            std::string text = "1";
            for (int i = 0; i < 200; ++i) text += i % 8 == 7 ? " 0.5\n" : " 0.5";
            return text;
          }(),
      10);
  CHECK(ten.elements[95].quantity == "S10,6");
}

TEST_CASE("Touchstone: noise parameters, comments and further option lines are passed over and told") {
  const auto t = table_of(
      "! made by hand\n# GHz RI ! options\n1 1 0 0 0 0 0 1 0\n2 1 0 0 0 0 0 1 0 ! end\n# MHz\n! noise\n1 0.7 0.6 10 0.4\n2 0.8 "
      "0.6 12 0.4\n",
      2);
  CHECK(t.frequency_hz == std::vector<double>{1e9, 2e9});
  CHECK(t.remarks == std::vector<std::string>{"4 comments passed over", "option lines after the first passed over",
                                              "noise parameters at 2 frequency points passed over"});
}

TEST_CASE("Touchstone: each kind of broken file is refused with its place and reason") {
  struct Case {
    const char* what;
    int ports;
    std::string text;
    const char* message;
  };
  using namespace std::string_literals;
  const std::vector<Case> cases = {
      {"empty file", 1, "", "F: empty file: no option line, no points"},
      {"comments alone", 1, "! a\n! b\n", "F: empty file: no option line, no points"},
      {"no points", 1, "# GHz\n! nothing\n", "F: no points"},
      {"no option line", 1, "1 2 3\n", "F:1:1: no option line before the first point, such as '# GHz S MA R 50'; found '1 2 3'"},
      {"unknown option", 1, "# GHz S XY R 50\n",
       "F:1:9: option 'xy'; allowed: Hz, kHz, MHz, GHz; S, Y, Z; DB, MA, RI; R and a number"},
      {"hybrid parameters", 2, "# GHz H MA\n", "F:1:7: hybrid parameters 'h' are not read; allowed: S, Y, Z"},
      {"option twice", 1, "# GHz MHz\n", "F:1:7: option 'mhz': the second of its kind"},
      {"R without number", 1, "# GHz S MA R\n", "F:1:12: R without the reference resistance in ohm"},
      {"R that is none", 1, "# R fifty\n", "F:1:5: reference resistance 'fifty' is not a number"},
      {"R of zero", 1, "# R 0\n", "F:1:5: reference resistance 0 ohm; above 0"},
      {"version 2", 2, "[Version] 2.0\n# GHz S MA R 50\n",
       "F:1:1: keyword '[Version] 2.0': Touchstone 2 is not read; save the file as version 1"},
      {"text in a point", 1, "# GHz\n1 0.5 abc\n", "F:2:7: 'abc' is not a number"},
      {"not finite", 1, "# GHz\n1 nan 0\n", "F:2:3: 'nan' is not finite"},
      {"beyond a double", 1, "# GHz\n1 1e999 0\n", "F:2:3: '1e999' is beyond the range of a double"},
      {"decibels beyond a double", 1, "# GHz DB\n1 1e5 0\n", "F:2: a value is beyond the range of a double"},
      {"frequency beyond a double", 1, "# GHz\n1e307 1 0\n", "F:2:1: the frequency is beyond the range of a double"},
      {"number missing", 1, "# GHz\n1 0.5\n", "F:2:1: 2 numbers where a point begins: its frequency and pairs are 3 for 1 port"},
      {"number too many", 1, "# GHz\n1 0.5 0 0.5 0\n", "F:2:9: surplus number: a point of 1 port has 3 with its frequency"},
      {"one-port data in a two-port file", 2, "# GHz\n1 0.5 0\n2 0.5 0\n",
       "F:2: the point has 3 numbers when the next begins in line 3; 9 for 2 ports"},
      {"cut off", 3, "# GHz\n1 1 0 1 0 1 0\n1 0 1 0 1 0\n", "F:2: the point has 13 numbers when the file ends; 19 for 3 ports"},
      {"frequencies that fall", 1, "# GHz\n2 1 0\n1 1 0\n",
       "F:3:1: frequencies do not rise: 1000000000 Hz after 2000000000 Hz in line 2"},
      {"point twice", 1, "# GHz\n2 1 0\n! again\n2 1 0\n", "F:4:1: point at 2000000000 Hz stands twice: it is in line 2 too"},
      {"negative frequency", 1, "# Hz\n-3 1 0\n", "F:2:1: frequency -3 Hz; at least 0"},
      {"damaged noise", 2, "# GHz\n2 1 0 0 0 0 0 1 0\n1 0.7 0.6 10 0.4\n2 0.8 0.6\n",
       "F:4:1: 3 numbers in the noise parameters; 5 a line: frequency, minimum noise figure, reflection (magnitude, angle), "
       "resistance"},
      {"NUL byte", 1, "# GHz\n1 \0 0\n"s, "F:2:3: NUL byte: this is no text, or the file is damaged"},
      {"decimal comma", 1, "# GHz\n1,5 1 0\n", "F:2:1: '1,5' is not a number"},
  };
  for (const Case& c : cases) {
    INFO(c.what);
    CHECK(test::message_of(read(c.text, c.ports)) == c.message);
  }
}

TEST_CASE("Touchstone: the ending tells the ports, one to ninety-nine") {
  CHECK(touchstone_ports(".s1p") == 1);
  CHECK(touchstone_ports(".s12p") == 12);
  for (const char* other : {".s0p", ".sp", ".s123p", ".s2", ".x2p", ".snp", ""}) CHECK_FALSE(touchstone_ports(other));
}
