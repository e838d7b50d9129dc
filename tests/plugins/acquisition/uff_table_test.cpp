#include "acquisition/uff_table.hpp"

#include <bit>
#include <cstdio>
#include <cstring>

#include "catch.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::Table;

namespace {

struct Function {
  int kind = 1, data_type = 4, points = 0, even = 1, abscissa_type = 17;
  int node = 12, direction = 3;
  double step = 0.001;
  const char* abscissa_unit = "s";
  const char* unit = "m/s^2";
  std::string values;
};

std::string line(const char* format, auto... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return std::string(text) + "\n";
}

std::string header(const Function& f) {
  std::string text = "bench, 3rd floor\nNONE\n22-Nov-26 10:00:00\nNONE\nNONE\n";
  text += line("%5d%10d%5d%10d %10s%10d%4d %10s%10d%4d", f.kind, 0, 0, 0, "NONE", f.node, f.direction, "NONE", 1, -1);
  text += line("%10d%10d%10d%13.5E%13.5E%13.5E", f.data_type, f.points, f.even, 0.0, f.step, 0.0);
  text += line("%10d%5d%5d%5d %-20s %-20s", f.abscissa_type, 0, 0, 0, "Time", f.abscissa_unit);
  text += line("%10d%5d%5d%5d %-20s %-20s", 12, 0, 0, 0, "Acceleration", f.unit);
  for (int i = 0; i < 2; ++i) text += line("%10d%5d%5d%5d %-20s %-20s", 0, 0, 0, 0, "NONE", "NONE");
  return text;
}

std::string set(const Function& f) { return "    -1\n    58\n" + header(f) + f.values + "    -1\n"; }

/// A function with the values first, first + 1 ...
Function ramp(int points, double first = 0.0, bool double_precision = true) {
  Function f;
  f.points = points;
  f.data_type = double_precision ? 4 : 2;
  const int a_line = double_precision ? 4 : 6;
  for (int n = 0; n < points; ++n) {
    char text[40];
    std::snprintf(text, sizeof text, double_precision ? "%20.12E" : "%13.5E", first + n);
    f.values += text;
    if (n % a_line == a_line - 1 || n == points - 1) f.values += "\n";
  }
  return f;
}

std::string binary_set(Function f, const std::vector<double>& values, bool big, bool wide) {
  f.points = static_cast<int>(values.size());
  f.data_type = wide ? 4 : 2;
  std::string bytes;
  for (const double v : values) {
    const std::uint64_t bits = wide ? std::bit_cast<std::uint64_t>(v) : std::bit_cast<std::uint32_t>(static_cast<float>(v));
    const int size = wide ? 8 : 4;
    for (int i = 0; i < size; ++i)
      bytes += static_cast<char>(bits >> static_cast<unsigned>(8 * (big ? size - 1 - i : i)) & 0xFFU);
  }
  return "    -1\n" +
         line("    58b%6d%6d%12d%12d%6d%6d%12d%12d", big ? 2 : 1, 2, 11, static_cast<int>(bytes.size()), 0, 0, 0, 0) + header(f) +
         bytes + "\n    -1\n";
}

Table read(const std::string& text, const std::vector<std::string>& names = {}, const Part& part = {}) {
  return test::read_whole(open_uff([&text] { return Expected<std::unique_ptr<ByteSource>>(open_memory(text)); }, "F"), names, {},
                          part);
}

std::vector<double> numbers(int count, double first = 0.0) {
  std::vector<double> x;
  for (int n = 0; n < count; ++n) x.push_back(first + n);
  return x;
}

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  return text.replace(text.find(old), old.size(), by);
}

}  // namespace

TEST_CASE("UFF58: time functions are columns named by their response, other data sets are passed over") {
  const std::string units = "    -1\n   164\n         1SI: Meter (newton)        2\n    -1\n";
  Function second = ramp(23, 100.0, false);
  second.direction = -2;
  Function response = ramp(5);
  response.kind = 4;
  response.abscissa_type = 18;
  const std::string text = units + set(ramp(23)) + set(response) + set(second);
  const Table t = read(text);
  REQUIRE(t.error == "");
  REQUIRE(t.columns.size() == 2);
  CHECK(t.columns[0].header == "f1");
  CHECK(t.columns[0].name == "12+Z");
  CHECK(t.columns[0].unit == "m/s^2");
  CHECK(t.columns[1].header == "f3");
  CHECK(t.columns[1].name == "12-Y");
  CHECK(t.summary.rate == Rate(1000, 1));
  CHECK(t.values == std::vector<std::vector<double>>{numbers(23), numbers(23, 100.0)});
  CHECK(read(text, {"12-Y"}, {20, {}, {}, {}}).values == std::vector<std::vector<double>>{numbers(3, 120.0)});
  CHECK(read(text, {"f2"}).error == "'f2' is a frequency response, no signal over time");
}

TEST_CASE("UFF58: binary functions of both byte orders and widths, whatever their bytes are") {
  std::vector<double> x = numbers(50, -25.0);
  x.push_back(std::bit_cast<double>(std::uint64_t{0x0A312D0A0A312D0A}));  // reads "\n-1\n\n-1\n"
  for (const bool big : {false, true}) {
    const Table t = read(binary_set({}, x, big, true) + binary_set({}, x, big, true));
    REQUIRE(t.error == "");
    CHECK(t.values == std::vector<std::vector<double>>{x, x});
  }
  x.pop_back();
  CHECK(read(binary_set({}, x, false, false), {}, {40, 5, {}, {}}).values == std::vector<std::vector<double>>{numbers(5, 15.0)});
}

TEST_CASE("UFF58: each kind of broken or surprising file is refused with its place and reason") {
  const std::string good = set(ramp(10));
  CHECK(read("").error == "F: empty file");
  CHECK(read("t,u\n0,1\n").error == "F:1:1: is no universal file: 't,u' where a data set begins with -1");
  CHECK(read("    -1\n   164\n  1\n    -1\n").error == "F: no function (data set 58) in it");
  CHECK(read(good.substr(0, good.size() - 7)).error == "F: the data set of line 2 is not closed by -1: is the file cut off?");
  CHECK(read(good + "    -1\n").error == "F:18: a data set begins here and the file ends");
  CHECK(read(good + "stray\n").error == "F:18:1: 'stray' where a data set begins with -1");
  CHECK(read("    -1\n    58\na\nb\n    -1\n").error == "F:5: function ends in its header, before its form (record 7)");
  CHECK(read("    -1\n    58\na\nb\nc\nd\ne\n    1\n         4        10         1  0.0 1.0\n    -1\n").error ==
        "F:10: function ends in its header, before its axes (records 8 to 11)");
  CHECK(read(replaced(good, "4.000000000000E+00", "4.00000x000000E+00")).error == "F:15:3: '4.00000x000000E+00' is not a number");
  CHECK(read(replaced(good, "4.000000000000E+00", "               nan")).error == "F: row 5: column 'f1': nan is not finite");
  CHECK(read(replaced(good, "4.000000000000E+00", "                  ")).error == "F:17: function ends after 9 of 10 values");
  CHECK(read(replaced(good, "    -1\n\0", "    -1\n")).error == "");
  Function more = ramp(12);
  more.points = 10;
  CHECK(read(set(more)).error == "F:16: more values than the 10 that the header states");
  more.points = 8;
  CHECK(read(set(more)).error == "F:16: more values than the 8 that the header states");
  more.points = 16;
  CHECK(read(set(more)).error == "F:17: function ends after 12 of 16 values");
  Function f = ramp(10);
  f.points = 0;
  CHECK(read(set(f)).error == "F:9:11: a function of 0 points");
  f.points = -3;
  CHECK(read(set(f)).error == "F:9:11: a function of -3 points");
  f = ramp(10);
  f.data_type = 3;
  CHECK(read(set(f)).error == "F:9:1: data type 3; known are 2, 4 (real) and 5, 6 (complex)");
  CHECK(read(replaced(good, "        10         1", "      ten!         1")).error ==
        "F:9:17: number of points: 'ten!         1  0.00000E+00  1.00000E-03...' is no number");
  CHECK(read(replaced(good, "    1         0", "    x         0")).error == "F:8:1: function type: 'x' is no whole number");
  f = ramp(10);
  f.data_type = 6;
  CHECK(read(set(f)).error == "F: no function over time in it: 'f1' is complex");
  f = ramp(10);
  f.even = 0;
  CHECK(read(set(f)).error == "F: no function over time in it: 'f1' has an uneven abscissa; resample it before");
  f = ramp(10);
  f.step = 0.0;
  CHECK(read(set(f)).error == "F: no function over time in it: 'f1' has an abscissa increment of 0");
  f = ramp(10);
  f.kind = 2;
  f.abscissa_type = 18;
  CHECK(read(set(f)).error == "F: no function over time in it: 'f1' is an auto spectrum, no signal over time");
  CHECK(read(good + set(ramp(12))).error ==
        "F: columns of different length: 'f1' has 10 rows, 'f2' has 12; name columns of one length");
  f = ramp(10);
  f.step = 0.002;
  CHECK(read(good + set(f)).error ==
        "F: two sampling rates: 'f1' has 1000 Hz, 'f2' has 500 Hz; read each with a block of its own");
  CHECK(read(good + set(f), {"12+Z"}).error == "column '12+Z' is ambiguous: f1, f2");
  f = ramp(10);
  f.abscissa_unit = "ms";
  CHECK(read(set(f)).summary.rate == Rate(1000000, 1));
}

TEST_CASE("UFF58: broken binary functions are refused") {
  const std::string good = binary_set({}, numbers(20), false, true);
  CHECK(read(replaced(good, "160", "152")).error == "F:2: binary function states 152 bytes, its 20 points need 160");
  CHECK(read(replaced(good, "58b     1     2", "58b     1     3")).error ==
        "F:2: binary function in other numbers than IEEE 754");
  CHECK(read(replaced(good, "          11", "          12")).error == "F:2: binary function with another header than 11 records");
  CHECK(read("    -1\n    58b     1\n").error == "F:2: binary function without its number of bytes");
  CHECK(read(good.substr(0, good.size() - 50)).error == "F: the data set of line 2 is not closed by -1: is the file cut off?");
}
