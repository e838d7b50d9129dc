#include "acquisition/csv.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "acquisition/printable.hpp"
#include "acquisition/summary.hpp"
#include "catch.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;

namespace {

/// All columns but time of a CSV text, or those named.
test::Table read_text(const std::string& text, const Timing& timing = {}, const std::vector<std::string>& names = {},
                      const Part& part = {}) {
  test::Table t = test::read_whole(open_csv(open_memory(text), "F"), names, timing, part);
  return t;
}

const Timing kAt10Hz{10.0, false, "", ""};

struct Broken {
  const char* what;
  std::string text;
  const char* message;
};

}  // namespace

TEST_CASE("CSV: each kind of broken file is refused with its place and reason") {
  using namespace std::string_literals;
  const std::vector<Broken> cases = {
      {"empty file", "", "F: empty file"},
      {"comments alone", "# a\n\n# b\n", "F: no header: only empty lines and comments"},
      {"no rows", "u [V],y [rad]\n", "F: no rows"},
      {"no header", "1.0,2.0\n3,4\n",
       "F:1:1: no header: the first line holds numbers; begin the file with a line of names, such as 't [s],u [V],y [rad]'"},
      {"no header, decimal commas", "1,5;2,5\n",
       "F:1:1: no header: the first line holds numbers; begin the file with a line of names, such as 't [s],u [V],y [rad]'"},
      {"column without a name", "u,,y\n1,2,3\n", "F:1:3: column 2 has no name"},
      {"duplicate name", "u,y,u\n1,2,3\n", "F:1:5: column name 'u' stands twice: columns 1 and 3"},
      {"name in Latin-1", "u,\xB0\n1,2\n", "F:1:3: the name of column 2, '?', is not UTF-8 text; save the file as UTF-8"},
      {"text that is not UTF-8", "u\n1\xFF\x1B[31m\xC3\xA9\n", "F:2:1: column 'u': '1??[31m\xC3\xA9' is not a number"},
      {"control characters in a name", "u\x1B[31m\nx\n", "F:2:1: column 'u?[31m': 'x' is not a number"},
      {"long text that is cut inside of a character", "u\n" + std::string(39, 'x') + "\xC3\xA9y\n",
       "F:2:1: column 'u': 'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...' is not a number"},
      {"two time columns", "t [s],u,time [ms]\n0,1,2\n",
       "F: several time columns, 't [s]' and 'time [ms]'; say which by time_column"},
      {"row too short", "u,y\n1,2\n3\n", "F:3:2: 1 field; the header has 2"},
      {"row too long", "u,y\n1,2\n3,4,5\n", "F:3:5: 3 fields; the header has 2"},
      {"two separators too many", "u,y\n1,2,,\n", "F:2:5: 4 fields; the header has 2"},
      {"last line cut off", "u,y\n1,2\n3,", "F:3:3: column 'y': value missing"},
      {"text for a number", "u,y [rad]\n1,2\n3,off\n", "F:3:3: column 'y [rad]': 'off' is not a number"},
      {"text behind a number", "u\n1.5V\n", "F:2:1: column 'u': '1.5V' is not a number"},
      {"hexadecimal", "u\n0x10\n", "F:2:1: column 'u': '0x10' is not a number"},
      {"two signs", "u\n+-1\n", "F:2:1: column 'u': '+-1' is not a number"},
      {"digit grouping in points", "u;y\n1.234,5;2\n", "F:2:1: column 'u': '1.234,5' is no number: grouped digits are not read"},
      {"digit grouping in commas", "u;y\n1,234,567;2\n", "F:2:1: column 'u': '1,234,567' is not a number"},
      {"nan", "u\n1\nnan\n", "F:3:1: column 'u': 'nan' is not finite"},
      {"infinity", "u\n-inf\n", "F:2:1: column 'u': '-inf' is not finite"},
      {"too large", "u\n1\n1e999\n", "F:3:1: column 'u': '1e999' is beyond the range of a double"},
      {"missing value", "u,y\n1,2\n,4\n", "F:3:1: column 'u': value missing"},
      {"decimal comma after points", "u;y\n1.5;2\n1,5;2\n",
       "F:3:1: column 'u': '1,5': decimal comma, but a decimal point in line 2"},
      {"decimal point after commas", "u;y\n1,5;2\n1;2.5\n",
       "F:3:3: column 'y': '2.5': decimal point, but a decimal comma in line 2"},
      {"quote not closed", "u,y\n1,2\n\"3,4\n5,6\n", "F:3:1: quote opened here is not closed on its line"},
      {"text after a quote", "u,y\n\"1\"2,3\n", "F:2:4: text after a closing quote"},
      {"empty line between rows", "u\n1\n\n2\n", "F:3:1: empty line between rows: is a sample lost here?"},
      {"NUL byte", "u,y\n1,2\n3,\0004\n"s, "F:3:3: NUL byte: this is no text, or the file is damaged"},
      {"NUL byte in the header", "u,\0y\n1,2\n"s, "F:1:3: NUL byte: this is no text, or the file is damaged"},
      {"carriage returns for line ends", "u,y\r1,2\r3,4\r", "F:1:4: carriage return inside a line; lines end with LF or CRLF"},
      {"UTF-16", "\xFF\xFEu\0,\0y\0\n\0"s, "F:1:1: UTF-16 text; save the file as UTF-8"},
      {"very long line", "u\n" + std::string(3 << 20, '1') + "\n", "F:2: line longer than 1 MiB: is this a table of text?"},
      {"very long line at the end", "u\n" + std::string(3 << 20, '1'), "F:2: line longer than 1 MiB: is this a table of text?"},
      {"long text in a number", "u\n" + std::string(60, 'x') + "\n",
       "F:2:1: column 'u': 'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...' is not a number"},
  };
  for (const Broken& c : cases) {
    INFO(c.what);
    CHECK(read_text(c.text, kAt10Hz).error == c.message);
  }
}

TEST_CASE("CSV: times that are not equally spaced are refused with the line and the step") {
  const std::vector<Broken> cases = {
      {"gap", "t [s],u\n0,1\n0.1,1\n0.2,1\n0.5,1\n",
       "F:5: gap of 2 samples after 0.2 s: a step of 0.3 s where samples are 0.1 s apart"},
      {"one sample lost", "t [ms],u\n0,1\n1,1\n2,1\n4,1\n",
       "F:5: gap of 1 sample after 0.002 s: a step of 0.002 s where samples are 0.001 s apart"},
      {"jitter", "t [s],u\n0,1\n1,1\n2.4,1\n",
       "F:4: not equally sampled: a step of 1.4 s after 1 s where samples are 1 s apart (tolerance 10 % of it)"},
      {"time stands still", "t [s],u\n0,1\n0.1,1\n0.1,1\n", "F:4: time 0.1 s stands twice"},
      {"time runs back", "t [s],u\n0,1\n0.1,1\n0.05,1\n", "F:4: time runs back: 0.05 s after 0.1 s"},
      {"one row", "t [s],u\n0,1\n", "F: one row, so the time column gives no sampling rate"},
      {"text for a time", "t [s],u\nnow,1\n", "F:2:1: column 't [s]': 'now' is not a number"},
      {"no time column", "u,y\n1,2\n",
       "F: no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the sampling rate, "
       "such as rate: 2500 Hz"},
      {"a time column without its unit", "t,u\n0,1\n1,1\n",
       "F: no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the sampling rate, "
       "such as rate: 2500 Hz, or if 't' holds time its unit, such as time_unit: s"},
      {"a column with a unit of time and another name", "Zeit [ms],u\n0,1\n1,1\n",
       "F: no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the sampling rate, "
       "such as rate: 2500 Hz, or if 'Zeit [ms]' holds time name it with time_column"},
  };
  for (const Broken& c : cases) {
    INFO(c.what);
    CHECK(read_text(c.text).error == c.message);
  }
  CHECK(read_text("t [s],u\n0,1\n0.1,2\n0.2,3\n", {12.0, false, "", ""}).error ==
        "F: the time column says 10 Hz, parameter rate says 12 Hz; time: ignore reads the file by the rate alone");
  CHECK(read_text("t [s],u\n0,1\n0.1,2\n0.2,3\n", {12.0, true, "", ""}).error.empty());
}

TEST_CASE("CSV: a unit of time is stated only where the file has none") {
  const auto error = [](const char* header, const char* unit) {
    return read_text(std::string(header) + "\n0,1\n1,2\n2,4\n", {std::nullopt, false, "", unit}, {"u"}).error;
  };
  CHECK(error("t,u", "ms") == "");
  CHECK(error("t [ms],u", "ms") == "");
  CHECK(error("t [s],u", "ms") ==
        "F: time_unit: ms is stated, but column 't [s]' has the unit s; leave time_unit out, or correct the file");
  CHECK(error("clock,u", "ms") ==
        "F: time_unit: no column `t` or `time` that holds time; name the one that does with time_column");
  CHECK(read_text("clock [s],u\n0,1\n1,2\n", {std::nullopt, false, "clock", "ms"}, {"u"}).error ==
        "F: time_unit: ms is stated, but column 'clock [s]' has the unit s; leave time_unit out, or correct the file");
}

TEST_CASE("CSV: slow drift of the sampling interval is refused, jitter within a tenth of a step is not") {
  std::string drift = "t [s],u\n", jitter = drift;
  double t = 0.0;
  for (int n = 0; n < 400; ++n) {
    drift += std::to_string(t) + ",1\n";
    t += 0.01 * (1.0 + 1e-3 * n / 4);
    jitter += std::to_string(0.01 * (n + (n % 3 - 1) * 0.04)) + ",1\n";
  }
  CHECK(read_text(drift).error.find("not equally sampled: time has drifted by more than 10 % of") != std::string::npos);
  const test::Table kept = read_text(jitter);
  CHECK(kept.error.empty());
  CHECK(kept.summary.rate.hz() == Approx(100.0).epsilon(1e-3));
}

TEST_CASE("CSV: the rate is the exact fraction that the written times mean") {
  const auto rate_of = [](double step, int rows, int decimals, const char* unit) {
    std::string text = std::string("t [") + unit + "],u\n";
    for (int n = 0; n < rows; ++n) {
      char line[64];
      std::snprintf(line, sizeof line, "%.*f,0\n", decimals, step * n);
      text += line;
    }
    return read_text(text).summary.rate;
  };
  CHECK(rate_of(0.0004, 1000, 4, "s") == Rate(2500, 1));
  CHECK(rate_of(0.0004, 3, 7, "s") == Rate(2500, 1));
  CHECK(rate_of(0.003, 500, 3, "s") == Rate(1000, 3));
  CHECK(rate_of(1.0 / 3000, 3000, 6, "s") == Rate(3000, 1));
  CHECK(rate_of(1.0 / 44100, 44100, 9, "s") == Rate(44100, 1));
  CHECK(rate_of(100.0, 50, 0, "us") == Rate(10000, 1));
  CHECK(rate_of(0.000412, 8, 6, "s") == Rate(1000000, 412));
}

TEST_CASE("CSV: separators, decimal commas, quotes, CRLF, BOM, comments and blanks all give the same table") {
  const std::vector<std::string> texts = {
      "u [V],y_rad\n1.5,-2\n0.25,1e3\n",
      "u [V],y_rad\r\n1.5,-2\r\n0.25,1e3\r\n",
      "\xEF\xBB\xBFu [V],y_rad\n1.5,-2\n0.25,1e3",
      "u [V];y_rad\n1,5;-2\n0,25;1e3\n",
      "u [V]\ty_rad\n1,5\t-2\n0,25\t1e3\n",
      "u [V]\ty_rad\n1.5\t-2\n0.25\t1e3\n",
      "\"u [V]\",\"y_rad\"\n\"1.5\",-2\n0.25,\"1e3\"\n",
      " u [V] , y_rad \n +1.5 ,-2 \n\t.25,+1E+3\n",
      "# made by hand\n\nu [V],y_rad\n\n1.5,-2\n# half\n0.25,1e3\n\n\n",
      "u [V],y_rad,\n1.5,-2,\n0.25,1e3,\n",
      "u [V],y_rad\n1.5,-2,\n0.25,1e3\n",
  };
  for (const std::string& text : texts) {
    INFO(text);
    const test::Table r = read_text(text, kAt10Hz);
    REQUIRE(r.error == "");
    REQUIRE(r.columns.size() == 2);
    CHECK(r.columns[0].name == "u");
    CHECK(r.columns[0].unit == "V");
    CHECK(r.columns[1].name == "y");
    CHECK(r.columns[1].unit == "rad");
    CHECK(r.summary.rows == 2);
    CHECK(r.values == std::vector<std::vector<double>>{{1.5, 0.25}, {-2.0, 1e3}});
    CHECK(r.summary.columns[1].least == -2.0);
    CHECK(r.summary.columns[1].greatest == 1e3);
  }
  CHECK(read_text(texts[3], kAt10Hz).summary.remarks == std::vector<std::string>{"decimal commas"});
  CHECK(read_text(texts[8], kAt10Hz).summary.remarks == std::vector<std::string>{"2 comment lines passed over"});
  CHECK(read_text(texts[9], kAt10Hz).summary.remarks == std::vector<std::string>{"separators at line ends passed over"});
}

TEST_CASE("CSV: columns that are not selected may hold anything but must keep the count of fields") {
  const std::string text = "when,u,note\n10:00,1,\"a, b\"\n10:01,2,\n10:02,3,nan\n";
  CHECK(read_text(text, kAt10Hz, {"u"}).values == std::vector<std::vector<double>>{{1, 2, 3}});
  CHECK(read_text("when,u\n10:00,1\n10:01,2,3\n", kAt10Hz, {"u"}).error == "F:3:9: 3 fields; the header has 2");
}

TEST_CASE("CSV: a name that is not UTF-8 does no harm where its column is not read") {
  const std::string text = "u,Temp [\xB0\x43],T\xB0,y\n1,a,b,2\n3,c,d,4\n";
  const test::Table read = read_text(text, kAt10Hz, {"u", "y"});
  CHECK(read.error == "");
  CHECK(read.values == std::vector<std::vector<double>>{{1, 3}, {2, 4}});
  CHECK(read.columns[1].header == "Temp [?C]");
  CHECK(read_text(text, kAt10Hz, {"u", "T?"}).error ==
        "F:1:13: the name of column 3, 'T?', is not UTF-8 text; save the file as UTF-8");
}

TEST_CASE("CSV: every double is read correctly rounded") {
  std::mt19937_64 random(7);
  std::string text = "u,v\n";
  std::vector<double> sent;
  for (int n = 0; n < 5000; ++n) {
    const auto bits = random();
    double x;
    std::memcpy(&x, &bits, sizeof x);
    if (!std::isfinite(x) || std::abs(x) < std::numeric_limits<double>::min()) x = 0.1 * n;
    sent.push_back(x);
    char line[64];
    std::snprintf(line, sizeof line, "%.17g,%d\n", x, n);
    text += line;
  }
  const test::Table r = read_text(text, kAt10Hz);
  REQUIRE(r.error == "");
  CHECK(r.values[0] == sent);
}

TEST_CASE("CSV: short decimal numbers are read as the C library reads them") {
  std::mt19937_64 random(8);
  std::string text = "u\n0\n-0\n0.0\n-0.000000000000001\n999999999999999\n9999999999999999\n1.\n.5\n00012.50\n";
  std::vector<double> expected = {0, -0.0, 0, -1e-15, 999999999999999, 9999999999999999.0, 1, 0.5, 12.5};
  for (int n = 0; n < 5000; ++n) {
    std::string number = std::to_string(random() % 1000000000000000);
    number.insert(random() % number.size() + 1, ".");
    if (n % 2 == 0) number.insert(0, "-");
    text += number + "\n";
    expected.push_back(std::strtod(number.c_str(), nullptr));
  }
  const test::Table r = read_text(text, kAt10Hz);
  REQUIRE(r.error == "");
  CHECK(r.values[0] == expected);
  CHECK(std::signbit(r.values[0][1]));
}

TEST_CASE("CSV: flat tops that come back are suspected of clipping, a constant or a single plateau is not") {
  std::string text = "clipped,sine,constant,step\n";
  for (int n = 0; n < 400; ++n) {
    const double s = std::sin(0.1 * n);
    text += std::to_string(std::min(s, 0.8)) + "," + std::to_string(s) + ",3," + (n < 200 ? "0\n" : "1\n");
  }
  const test::Table r = read_text(text, kAt10Hz);
  REQUIRE(r.error == "");
  CHECK(clipping_suspicion(r.summary.columns[0]) == "rests 7 times at 0.8 for three samples or more: clipped?");
  for (const std::size_t c : {1u, 2u, 3u}) CHECK(clipping_suspicion(r.summary.columns[c]) == "");
}

TEST_CASE("CSV: a column of two values is binary, not clipped") {
  std::string text = "binary,late,clipped\n";
  for (int n = 0; n < 9000; ++n)
    text += std::string(n / 5 % 2 == 0 ? "-2," : "3,") +
            (n == 8000        ? "0.5,"
             : n / 5 % 2 == 0 ? "-2,"
                              : "3,") +
            (n / 5 % 2 == 0 ? "-2\n"
             : n % 5 == 0   ? "1\n"
                            : "3\n");
  const test::Table r = read_text(text, kAt10Hz);
  REQUIRE(r.error == "");
  CHECK(clipping_suspicion(r.summary.columns[0]) == "");
  CHECK(clipping_suspicion(r.summary.columns[1]) ==
        "rests 900 times at -2 and 900 times at 3 for three samples or more: clipped?");
  CHECK(clipping_suspicion(r.summary.columns[2]) ==
        "rests 900 times at -2 and 900 times at 3 for three samples or more: clipped?");
}

TEST_CASE("CSV: header names and their units") {
  const auto is = [](const char* header, const char* name, const char* unit) {
    INFO(header);
    const Column c = parse_header(header);
    CHECK(c.name == name);
    CHECK(c.unit == unit);
  };
  is("iq_A", "iq", "A");
  is("iq_ref_A", "iq_ref", "A");
  is("theta_motor [rad]", "theta_motor", "rad");
  is("omega [rad/s]", "omega", "rad/s");
  is("omega_rad/s", "omega", "rad/s");
  is("Time (s)", "Time", "s");
  is("CH1 ( V )", "CH1", "V");
  is("CH 2 (rad/s)", "CH 2", "rad/s");
  is("speed (filtered)", "speed (filtered)", "");
  is("re(V)", "re(V)", "");
  is("(V)", "(V)", "");
  is(")", ")", "");
  is("]", "]", "");
  is("iq_ref", "iq_ref", "");
  is("u_1", "u_1", "");
  is("x_min", "x_min", "");
  is("x [furlong]", "x [furlong]", "");
  is("[V]", "[V]", "");
  is("_V", "_V", "");
}

TEST_CASE("CSV: units in parentheses, as oscilloscopes write them, make a time column") {
  const test::Table t = read_text("Time (s),CH1 (V)\n-0.002,1\n-0.001,2\n0,4\n");
  REQUIRE(t.error == "");
  CHECK(t.summary.rate == Rate(1000, 1));
  CHECK(t.values == std::vector<std::vector<double>>{{1, 2, 4}});
  CHECK(t.columns[1].unit == "V");
}

TEST_CASE("CSV: columns are found with and without their unit, and the nearest name is offered") {
  std::vector<Column> columns;
  for (const char* h : {"iq_ref_A", "iq_A", "theta_motor [rad]", "w [rad/s]", "w [V]"}) columns.push_back(parse_header(h));
  CHECK(*find_column(columns, "iq") == 1);
  CHECK(*find_column(columns, "iq_A") == 1);
  CHECK(*find_column(columns, " iq [A]") == 1);
  CHECK(*find_column(columns, "theta_motor_rad") == 2);
  CHECK(*find_column(columns, "w [V]") == 4);
  CHECK(find_column(columns, "w").error().text == "column 'w' is ambiguous: w [rad/s], w [V]");
  CHECK(find_column(columns, "theta_moter").error().text ==
        "no column 'theta_moter'; the file has iq_ref_A, iq_A, theta_motor [rad], w [rad/s], w [V] (did you mean 'theta_motor "
        "[rad]'?)");
  CHECK(find_column(columns, "pressure").error().text ==
        "no column 'pressure'; the file has iq_ref_A, iq_A, theta_motor [rad], w [rad/s], w [V]");
}

TEST_CASE("printable text is UTF-8 without control characters, whatever the bytes") {
  CHECK(printable("a\tb\x1B\x7F") == "a?b??");
  CHECK(printable("\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x99\x82") == "\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x99\x82");
  CHECK(printable("\xC2\x9B") == "?");          // a control character of two bytes
  CHECK(printable("\xED\xA0\x80") == "???");    // half of a pair
  CHECK(printable("\xC0\x80\xFFx") == "???x");  // an overlong form
  CHECK(printable("\xE2\x82") == "??");         // cut off
  CHECK(printable(std::string("\0", 1)) == "?");
}
