#include "acquisition/response_csv.hpp"

#include <cmath>

#include "acquisition/response_header.hpp"
#include "response_text.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::check_near;

namespace {

Expected<ResponseTable, TextError> read(const std::string& text, const std::vector<std::string>& quantities = {}) {
  return read_response_csv(*open_memory(text), quantities);
}

ResponseTable table_of(const std::string& text, const std::vector<std::string>& quantities = {}) {
  auto table = read(text, quantities);
  INFO(test::message_of(table));
  REQUIRE(table);
  return *table;
}

std::string meaning(const char* header) {
  const auto c = response_column(header);
  if (!c) return "none";
  static constexpr const char* kParts[] = {"f", "re", "im", "abs", "phase", "var", "std"};
  return std::string(kParts[static_cast<int>(c->part)]) + " " + c->quantity + " [" + c->unit + "]";
}

}  // namespace

TEST_CASE("response CSV: a name that is not UTF-8 is refused where it means a quantity") {
  const auto message = [](const std::string& text) {
    const auto source = open_memory(text);
    return test::message_of(read_response_csv(*source, {}));
  };
  CHECK(message("f [Hz],re(G11),im(G11),T\xB0\n1,2,3,x\n") == "read");
  CHECK(message("f [Hz],re(G\xB0),im(G\xB0)\n1,2,3\n") ==
        "F:1:8: the name of column 2, 're(G?)', is not UTF-8 text; save the file as UTF-8");
}

TEST_CASE("response CSV: headers say part, quantity and unit") {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"f [Hz]", "f  [Hz]"},
      {"f_Hz", "f  [Hz]"},
      {"frequency", "f  [Hz]"},
      {"Frequency (kHz)", "f  [kHz]"},
      {"omega [rad/s]", "f  [rad/s]"},
      {"omega_rad_s", "f  [rad/s]"},
      {"w", "f  [rad/s]"},
      {"re(G11)", "re G11 []"},
      {"im(G11) [V/A]", "im G11 [V/A]"},
      {"reZ_ohm", "re Z [ohm]"},
      {"Re_G", "re G []"},
      {"ImGn", "im Gn []"},
      {"real", "re G []"},
      {"imag(G)", "im G []"},
      {"absY_S", "abs Y [S]"},
      {"|G| [V]", "abs G [V]"},
      {"mag_dB", "abs G [dB]"},
      {"magnitude (dB)", "abs G [dB]"},
      {"db(S21)", "abs S21 [dB]"},
      {"phaseZ_deg", "phase Z [deg]"},
      {"arg(G) [rad]", "phase G [rad]"},
      {"angle G12 [deg]", "phase G12 [deg]"},
      {"var(G11)", "var G11 []"},
      {"std(G)", "std G []"},
      {"reference", "none"},
      {"image", "none"},
      {"coherence", "none"},
      {"variable", "none"},
  };
  for (const auto& [header, expected] : cases) {
    INFO(header);
    CHECK(meaning(header) == expected);
  }
}

TEST_CASE("response CSV: real and imaginary part, magnitude and phase, dB and radians give the same response") {
  const std::complex<double> g = std::polar(2.0, -M_PI / 3);
  for (const char* text :
       {"f [Hz],re(G),im(G)\n5,1,-1.7320508075688772\n", "f_Hz;absG;phaseG_deg\n5;2;-60\n",
        "frequency,db(G),phase(G) [rad]\n5,6.020599913279624,-1.0471975511965976\n",
        "omega [rad/s]\tmag\tphase_deg\n31.41592653589793\t2\t-60\n", "f [kHz];abs(G);arg(G) [deg]\n0,005;2,0;-60\n"}) {
    INFO(text);
    const auto t = table_of(text);
    CHECK(t.frequency_hz[0] == Approx(5.0).epsilon(1e-14));
    REQUIRE(t.elements.size() == 1);
    check_near(t.elements[0].value[0], g);
  }
}

TEST_CASE("response CSV: indexed quantities fill a matrix with their variances") {
  const auto t = table_of(
      "f [Hz],re(G11),im(G11),var(G11),re(G12),im(G12),std(G12),re(G21),im(G21),var(G21),re(G22),im(G22),var(G22),note\n"
      "1,11,0,1,12,0,2,21,0,3,22,0,4,x\n2,11,1,1,12,1,2,21,1,3,22,1,4,y\n");
  REQUIRE(t.elements.size() == 4);
  CHECK(t.elements[2].output == "y2");
  CHECK(t.elements[2].input == "u1");
  CHECK(t.elements[1].variance == std::vector<double>{4.0, 4.0});
  const auto r = assemble(t, {});
  REQUIRE(r);
  CHECK(r->output_names == std::vector<std::string>{"y1", "y2"});
  CHECK(r->input_names == std::vector<std::string>{"u1", "u2"});
  CHECK(r->value[6] == std::complex<double>(21, 1));
  CHECK(r->variance == std::vector<double>{1, 4, 3, 4, 1, 4, 3, 4});
  CHECK(r->remarks.back() == "not read: note");
  const auto one = assemble(table_of("f,re(G11),im(G11),re(G12),im(G12)\n1,1,1,2,2\n", {"G12"}), {{"G12"}, {}});
  REQUIRE(one);
  CHECK(one->value == std::vector<std::complex<double>>{{2, 2}});
}

TEST_CASE("response CSV: magnitude and phase that contradict real and imaginary part are told, with the line") {
  const auto t = table_of("f,re(G),im(G),abs(G),phase(G) [deg]\n1,1,0,1,0\n2,1,0,1,90\n");
  CHECK(t.warnings ==
        std::vector<std::string>{
            "G: magnitude and phase differ from real and imaginary part by up to 141.421 %, in line 3; the latter were read"});
  CHECK(t.elements[0].value[1] == std::complex<double>(1, 0));
}

TEST_CASE("response CSV: each kind of broken file is refused with its place and reason") {
  using namespace std::string_literals;
  const std::vector<test::BrokenResponse> cases = {
      {"empty file", "", "F: empty file"},
      {"no header", "1,2,3\n",
       "F:1:1: no header: the first line holds numbers; begin the file with a line of names, such as 't [s],u [V],y [rad]'"},
      {"no rows", "f,re(G),im(G)\n", "F:1: no rows follow the header"},
      {"no frequency", "t,re(G),im(G)\n1,2,3\n",
       "F:1:1: no frequency column: `f [Hz]`, `frequency`, `omega [rad/s]`; found 't,re(G),im(G)'"},
      {"two frequencies", "f [Hz],re(G),im(G),omega [rad/s]\n1,2,3,4\n",
       "F:1:20: two frequency columns, 'f [Hz]' and 'omega [rad/s]'"},
      {"frequency in metres", "f [m],re(G),im(G)\n1,2,3\n",
       "F:1:1: column 'f [m]': unit 'm' is none of frequency, such as Hz or rad/s"},
      {"no response", "f,u,y\n1,2,3\n",
       "F:1: no response columns: `re(G11)` and `im(G11)`, or `abs(G11)` or `db(G11)` and `phase(G11) [deg]`; found 'u, y'"},
      {"phase without a unit", "f,abs(G),phase(G)\n1,2,3\n",
       "F:1:10: column 'phase(G)': a phase needs its unit, `phase(G) [deg]` or `[rad]`"},
      {"magnitude alone", "f,db(G)\n1,2\n", "F:1:3: column 'db(G)' without the phase of 'G'"},
      {"phase alone", "f,phase(G) [deg]\n1,2\n", "F:1:3: column 'phase(G) [deg]' without the magnitude of 'G'"},
      {"real part alone", "f,re(G11),im(G12)\n1,2,3\n", "F:1:3: column 're(G11)' without the imaginary part of 'G11'"},
      {"imaginary part alone", "f,im(G)\n1,2\n", "F:1:3: column 'im(G)' without the real part of 'G'"},
      {"variance alone", "f,var(G)\n1,2\n", "F:1:3: column 'var(G)': there is no value of 'G'"},
      {"part twice", "f,re(G),im(G),real(G)\n1,2,3,4\n", "F:1:15: columns 're(G)' and 'real(G)' mean the same"},
      {"parts in different units", "f,re(G) [V],im(G) [mV]\n1,2,3\n",
       "F:1:13: columns 're(G) [V]' and 'im(G) [mV]' differ in their units"},
      {"variance and deviation", "f,re(G),im(G),var(G),std(G)\n1,2,3,4,2\n",
       "F:1:22: both variance and standard deviation of 'G'; one is enough"},
      {"negative variance", "f,re(G),im(G),var(G)\n1,2,3,-4\n", "F:2: column 'var(G)': -4; at least 0"},
      {"negative magnitude", "f,abs(G),phase(G) [deg]\n1,-2,3\n", "F:2: column 'abs(G)': magnitude -2; at least 0"},
      {"decibels beyond a double", "f,db(G),phase(G) [deg]\n1,7000,3\n",
       "F:2: column 'db(G)': 7000 dB is beyond the range of a double"},
      {"row too short", "f,re(G),im(G)\n1,2\n", "F:2:4: 2 fields; the header has 3"},
      {"row too long", "f,re(G),im(G)\n1,2,3,4\n", "F:2:7: 4 fields; the header has 3"},
      {"text", "f,re(G),im(G)\n1,x,3\n", "F:2:3: column 're(G)': 'x' is not a number"},
      {"missing value", "f,re(G),im(G)\n1,,3\n", "F:2:3: column 're(G)': value missing"},
      {"not finite", "f,re(G),im(G)\n1,nan,3\n", "F:2:3: column 're(G)': 'nan' is not finite"},
      {"frequencies that fall", "f,re(G),im(G)\n2,2,3\n1,2,3\n", "F:3: frequencies do not rise: 1 Hz after 2 Hz in line 2"},
      {"point twice", "f,re(G),im(G)\n2,2,3\n2,2,3\n", "F:3: point at 2 Hz stands twice: it is in line 2 too"},
      {"negative frequency", "f,re(G),im(G)\n-2,2,3\n", "F:2: frequency -2 Hz; at least 0"},
      {"empty line between rows", "f,re(G),im(G)\n1,2,3\n\n2,2,3\n", "F:3:1: empty line between rows: is a point lost here?"},
      {"quote not closed", "f,\"re(G),im(G)\n1,2,3\n", "F:1:3: quote opened here is not closed on its line"},
      {"NUL byte", "f,re(G),im(G)\n1,\0,3\n"s, "F:2:3: NUL byte: this is no text, or the file is damaged"},
  };
  for (const auto& c : cases) {
    INFO(c.what);
    CHECK(test::message_of(read(c.text)) == c.message);
  }
  CHECK(test::message_of(read("f,re(G),im(G)\n1,2,3\n", {"Z"})) == "F:1: no quantity of those wanted; the file has G");
}
