#include "acquisition/uff_response.hpp"

#include <cstdio>
#include <cstring>

#include "response_text.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;

namespace {

Expected<ResponseTable, TextError> read(const std::string& text) { return read_uff_response(*open_memory(text)); }

/// One function as an analyser writes it: fixed columns, numbers in rows of six.
struct Function {
  int type = 4;
  int response_node = 12, response_direction = 3, reference_node = 5, reference_direction = -1;
  int data_type = 5;
  int points = 3, even = 1;
  double start = 10.0, step = 2.5;
  int abscissa = 18;
  std::string abscissa_unit = "Hz";
  int ordinate = 12;
  std::string ordinate_unit = "m/s^2", reference_unit = "N";
  std::vector<double> values = {1, -2, 3, -4, 5, -6};
  int per_line = 6;

  std::string text() const {
    char line[200];
    std::string t = "    -1\n    58\nmeasured by hand\nNONE\n22-Nov-26 04:00:00\nNONE\nNONE\n";
    std::snprintf(line, sizeof line, "%5d%10d%5d%10d %-10s%10d%4d %-10s%10d%4d\n", type, 1, 1, 0, "NONE", response_node,
                  response_direction, "NONE", reference_node, reference_direction);
    t += line;
    std::snprintf(line, sizeof line, "%10d%10d%10d%13.5E%13.5E%13.5E\n", data_type, points, even, start, step, 0.0);
    t += line;
    const auto axis = [&](int type_code, const std::string& unit) {
      std::snprintf(line, sizeof line, "%10d%5d%5d%5d %-20s %-20s\n", type_code, 0, 0, 0, "NONE", unit.c_str());
      t += line;
    };
    axis(abscissa, abscissa_unit);
    axis(ordinate, ordinate_unit);
    axis(13, reference_unit);
    axis(0, "NONE");
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::snprintf(line, sizeof line, "%13.5E", values[i]);
      t += line;
      if (i % static_cast<std::size_t>(per_line) == static_cast<std::size_t>(per_line) - 1 || i + 1 == values.size()) t += '\n';
    }
    return t + "    -1\n";
  }
};

template <class Change>
std::string with(Change&& change) {
  Function f;
  change(f);
  return f.text();
}

}  // namespace

TEST_CASE("UFF responses: functions merge into a matrix named by node and direction, with their unit") {
  std::string text = "    -1\n   151\nmodel\n    -1\n";
  for (const int output : {1, 2}) {
    for (const int input : {3, 4}) {
      text += with([&](Function& f) {
        f.response_node = output;
        f.reference_node = input;
        f.values = {10.0 * output + input, 1, 0, 2, 0, 3};
      });
    }
  }
  text += with([](Function& f) { f.type = 6; });
  auto table = read(text);
  INFO(test::message_of(table));
  REQUIRE(table);
  CHECK(table->frequency_hz == std::vector<double>{10.0, 12.5, 15.0});
  CHECK(table->format == "universal file, 4 frequency response functions");
  CHECK(table->remarks == std::vector<std::string>{"passed over: 1 coherence, 1 other data set"});
  const auto r = assemble(*table, {});
  REQUIRE(r);
  CHECK(r->output_names == std::vector<std::string>{"1+Z", "2+Z"});
  CHECK(r->input_names == std::vector<std::string>{"3-X", "4-X"});
  CHECK(r->units == std::vector<std::string>(4, "m/s^2/N"));
  CHECK(r->value[2] == std::complex<double>(23, 1));
  CHECK(r->value[4 + 3] == std::complex<double>(0, 2));
  const auto one = assemble(*table, {{"2+Z/3-X"}, {}});
  REQUIRE(one);
  CHECK(one->value[0] == std::complex<double>(23, 1));
}

TEST_CASE("UFF responses: uneven abscissas, angular frequencies, gravity and missing units") {
  auto table = read(with([](Function& f) {
    f.even = 0;
    f.per_line = 6;
    f.values = {1, 1, 0, 4, 2, 0, 9, 3, 0};
    f.ordinate_unit = "g";
  }));
  REQUIRE(table);
  CHECK(table->frequency_hz == std::vector<double>{1, 4, 9});
  CHECK(table->elements[0].value[2] == std::complex<double>(3, 0));
  CHECK(table->elements[0].unit == "gn/N");
  table = read(with([](Function& f) { f.abscissa_unit = "rad/s"; }));
  REQUIRE(table);
  CHECK(table->frequency_hz[0] == Approx(10 / (2 * M_PI)).epsilon(1e-15));
  table = read(with([](Function& f) { f.abscissa_unit = f.ordinate_unit = "NONE"; }));
  REQUIRE(table);
  CHECK(table->elements[0].unit == "");
  CHECK(table->remarks == std::vector<std::string>{"the file does not say the unit of its frequencies: taken as Hz"});
}

TEST_CASE("UFF responses: binary functions give the same values") {
  const Function f;
  std::string text = f.text();
  const std::string head = "    58b     1     2          11          24     0     0           0           0";
  text.replace(text.find("    58\n"), 6, head);
  const std::size_t begin = text.find("  1.00000E+00");
  std::string bytes;
  for (const double v : f.values) {
    const auto single = static_cast<float>(v);
    char raw[4];
    std::memcpy(raw, &single, 4);
    bytes.append(raw, 4);
  }
  text = text.substr(0, begin) + bytes + "    -1\n";
  auto table = read(text);
  INFO(test::message_of(table));
  REQUIRE(table);
  CHECK(table->elements[0].value == std::vector<std::complex<double>>{{1, -2}, {3, -4}, {5, -6}});
}

TEST_CASE("UFF responses: each kind of broken file is refused with its place and reason") {
  using namespace std::string_literals;
  const auto cut = [](std::string text, const char* at) { return text.substr(0, text.find(at)); };
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string whole = Function().text();
  const std::vector<test::BrokenResponse> cases = {
      {"empty file", "", "F: empty file"},
      {"no universal file", "hello\n", "F:1:1: is no universal file: 'hello' where a data set begins with -1"},
      {"no functions", "    -1\n   151\nmodel\n    -1\n",
       "F: no frequency response function (data set 58 of type 4); found 1 other data set"},
      {"other functions alone", with([](Function& f) { f.type = 2; }),
       "F: no frequency response function (data set 58 of type 4); found 1 auto spectrum"},
      {"real ordinate", with([](Function& f) {
         f.data_type = 2;
         f.values = {1, 2, 3};
       }),
       "F:14: the function that begins here has real values; a frequency response is complex (data type 5 or 6)"},
      {"unknown ordinate", with([](Function& f) { f.data_type = 7; }),
       "F:9:1: data type 7; known are 2, 4 (real) and 5, 6 (complex)"},
      {"time abscissa", with([](Function& f) { f.abscissa = 17; }),
       "F:14: the function that begins here has an abscissa of type 17; of a frequency response 18 (frequency)"},
      {"abscissa in seconds", with([](Function& f) { f.abscissa_unit = "s"; }),
       "F:14: the function that begins here has frequencies in 's'; Hz or rad/s"},
      {"no points", with([](Function& f) { f.points = 0; }), "F:9:11: a function of 0 points"},
      {"abscissa that falls", with([](Function& f) { f.step = -1; }),
       "F:14: frequencies do not rise: 9 Hz after 10 Hz in line 14"},
      {"abscissa that stands", with([](Function& f) { f.step = 0; }), "F:14: point at 10 Hz stands twice: it is in line 14 too"},
      {"negative frequency", with([](Function& f) { f.start = -2; }), "F:14: frequency -2 Hz; at least 0"},
      {"too few values", with([](Function& f) { f.points = 4; }), "F:15: function ends after 6 of 8 values"},
      {"too many values", with([](Function& f) { f.points = 2; }), "F:14: more values than the 4 that the header states"},
      {"text in the values", replaced(whole, " 3.00000E+00", " 3.0000xE+00"), "F:14:29: '3.0000xE+00' is not a number"},
      {"value not finite", replaced(whole, " 3.00000E+00", "         nan"), "F:14: value nan is not finite"},
      {"header cut off", cut(whole, "        18") + "    -1\n",
       "F:10: function ends in its header, before its axes (records 8 to 11)"},
      {"not closed", whole.substr(0, whole.size() - 7), "F: the data set of line 2 is not closed by -1: is the file cut off?"},
      {"node that is none", replaced(whole, "        12   3", "        1x   3"),
       "F:8:42: response node: '1x' is no whole number"},
      {"other frequencies", whole + with([](Function& f) { f.step = 3; }),
       "F:29: the function that begins here has other frequencies, 3 points from 10 to 16 Hz, than the one of line 14, 3 points "
       "from 10 to 15 Hz"},
  };
  for (const auto& c : cases) {
    INFO(c.what);
    CHECK(test::message_of(read(c.text)) == c.message);
  }
  const auto twice = read(whole + whole);
  REQUIRE(twice);
  CHECK(assemble(*twice, {}).error().text ==
        "'12+Z/5-X' and '12+Z/5-X' are both the response from '5-X' to '12+Z'; name one with `quantity`");
}
