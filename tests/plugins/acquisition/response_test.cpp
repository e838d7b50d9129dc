#include "acquisition/response.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "read_whole.hpp"
#include "response_text.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::TemporaryFile;

namespace {

ResponseTable table_of(std::initializer_list<std::pair<const char*, const char*>> elements) {
  ResponseTable t;
  t.frequency_hz = {0.0, 1.0, 2.0};
  for (const auto& [output, input] : elements) {
    ResponseElement e;
    e.quantity = std::string(output) + "/" + input;
    e.output = output;
    e.input = input;
    e.value = {{1, 0}, {2, 0}, {3, 0}};
    t.elements.push_back(std::move(e));
  }
  return t;
}

std::string error_of(ResponseTable table, const ResponseSelection& wanted = {}) {
  const auto r = assemble(std::move(table), wanted);
  return r ? "assembled" : r.error().text;
}

/// A file of the shared data, or "" with the reason printed.
std::string shared_file(const char* name) {
  const char* given = std::getenv("BODEFLOW_DATA");
  const auto path = std::filesystem::path(given != nullptr ? given : BODEFLOW_SOURCE_DIR "/../shared/data") / name;
  if (std::filesystem::exists(path)) return path.string();
  std::cout << "skipped: " << path.string() << " is absent (set BODEFLOW_DATA)\n";
  return "";
}

Response whole(const std::string& path) {
  auto table = read_response(path, {});
  REQUIRE(table);
  auto response = assemble(std::move(*table), {});
  REQUIRE(response);
  return *response;
}

}  // namespace

TEST_CASE("response: elements fill a matrix, or what is missing, twice or unknown is named") {
  const auto r = assemble(table_of({{"y", "u"}, {"z", "u"}}), {{}, std::pair(0.5, 1.5)});
  REQUIRE(r);
  CHECK(r->frequency_hz == std::vector<double>{1.0});
  CHECK(r->value == std::vector<std::complex<double>>{{2, 0}, {2, 0}});
  CHECK(r->remarks == std::vector<std::string>{"2 points outside the band left out"});
  CHECK(error_of(table_of({{"y", "u"}, {"z", "v"}})) ==
        "no response from 'v' to 'y': 2 of 2 x 2 elements are there; name some that fill a matrix with `quantity`");
  CHECK(error_of(table_of({{"y", "u"}, {"z", "v"}}), {{"z/v"}, {}}) == "assembled");
  CHECK(error_of(table_of({{"y", "u"}, {"y", "u"}})) ==
        "'y/u' and 'y/u' are both the response from 'u' to 'y'; name one with `quantity`");
  CHECK(error_of(table_of({{"y", "u"}}), {{"G"}, {}}) == "no quantity 'G'; the file has y/u");
  CHECK(error_of(table_of({{"y", "u"}}), {{}, std::pair(3.0, 4.0)}) ==
        "no point within the band from 3 to 4 Hz; the file has 0 to 2 Hz");
  auto half = table_of({{"y", "u"}, {"z", "u"}});
  half.elements[1].variance = {1, 1, 1};
  CHECK(error_of(half) == "variances of 1 of 2 elements alone");
}

TEST_CASE("response: a point at zero frequency is told") {
  const auto r = assemble(table_of({{"y", "u"}}), {});
  REQUIRE(r);
  CHECK(r->warnings ==
        std::vector<std::string>{"the first point is at 0 Hz: a fit over a logarithmic axis can't use it; `band` leaves it out"});
}

TEST_CASE("response: the grid is named, also when its frequencies are rounded") {
  CHECK(grid_text({1, 2}) == "");
  CHECK(grid_text({0, 2.5, 5, 7.5}) == "linear grid, 2.5 Hz apart");
  CHECK(grid_text({0, 1, 2, 4, 8}) == "logarithmic grid, 1 points an octave");
  CHECK(grid_text({10, 10.2, 10.4, 10.61, 10.82, 11.04, 11.26, 11.49}) == "linear grid, 0.212857 Hz apart");
  CHECK(grid_text({10, 20, 25, 40}) == "irregular grid");
}

TEST_CASE("response: the ending chooses the format, and others are refused with those that are read") {
  const TemporaryFile frd(".FRD", "10 0 0\n");
  CHECK(whole(frd.path()).value[0] == std::complex<double>(1, 0));
  const TemporaryFile other(".xyz", "10 0 0\n");
  CHECK(read_response(other.path(), {}).error().text ==
        other.path() +
            ": ending '.xyz'; read are .csv, .txt, .tsv, .dat, .s1p to .s99p (Touchstone), .frd, .zma, .uff, .unv, .u58");
  CHECK(read_response("/nowhere/a.s2p", {}).error().text == "/nowhere/a.s2p: can't be opened: No such file or directory");
  const TemporaryFile broken(".s1p", "# GHz\n1 x 0\n");
  CHECK(read_response(broken.path(), {}).error().text == broken.path() + ":2:3: 'x' is not a number");
}

TEST_CASE("response: the loudspeaker impedances are read with their shape and values") {
  for (const char* name : {"L16RNX_0g.csv", "L16RNX_8p017g.csv", "L16RNX_16p048g.csv"}) {
    const std::string path = shared_file((std::string("loudspeaker_impedance/") + name).c_str());
    if (path.empty()) return;
    const Response r = whole(path);
    CHECK(r.frequency_hz.size() == 386);
    CHECK(r.frequency_hz.front() == 10.0);
    CHECK(r.units == std::vector<std::string>{"ohm"});
    CHECK(r.warnings.empty());
  }
  const Response r = whole(shared_file("loudspeaker_impedance/L16RNX_0g.csv"));
  CHECK(r.value[0] == std::complex<double>(6.4391931, 3.0333632));
  CHECK(r.frequency_hz[28] == 17.405);
  CHECK(r.value[28] == std::complex<double>(7.580448, 5.3821277));
  CHECK(grid_text(r.frequency_hz) == "irregular grid");  // 35 points an octave, but the last two are 0.4 Hz apart
}

TEST_CASE("response: the transformer's admittance is read with its shape, values and DC point") {
  const std::string path = shared_file("transformer_admittance/03PK10.csv");
  if (path.empty()) return;
  const Response r = whole(path);
  REQUIRE(r.frequency_hz.size() == 401);
  CHECK(r.frequency_hz[400] == 10e6);
  CHECK(grid_text(r.frequency_hz) == "linear grid, 25000 Hz apart");
  CHECK(r.value[1] == std::complex<double>(0.00030502274, 0.00088861647));
  CHECK(r.units == std::vector<std::string>{"S"});
  CHECK(r.warnings.size() == 1);
}

TEST_CASE("response: measured Touchstone files are read with their shape and values") {
  const std::string one = shared_file("touchstone/ringslot_measured.s1p"), four = shared_file("touchstone/Agilent_E5071B.s4p");
  if (one.empty() || four.empty()) return;
  const Response ring = whole(one);
  REQUIRE(ring.frequency_hz.size() == 101);
  CHECK(ring.frequency_hz.front() == 75e9);
  CHECK(ring.frequency_hz.back() == Approx(110e9).epsilon(1e-9));
  CHECK(ring.value[0] == std::complex<double>(-0.067684517179, 0.659208635995));
  const Response agilent = whole(four);
  REQUIRE(agilent.frequency_hz.size() == 205);
  CHECK(agilent.frequency_hz.front() == 500e6);
  CHECK(agilent.frequency_hz.back() == 4.5e9);
  REQUIRE(agilent.value.size() == 205 * 16);
  CHECK(agilent.format == "Touchstone 1, 4 ports, S parameters, reference 75 ohm");
  const auto from_db = [](double db, double degrees) { return std::polar(std::pow(10.0, db / 20), degrees * M_PI / 180); };
  test::check_near(agilent.value[0], from_db(-2.290151e-001, 1.778212e+002));
  test::check_near(agilent.value[3], from_db(-8.099038e+001, 1.194139e+002));        // S14
  test::check_near(agilent.value[12], from_db(-8.139571e+001, 1.290694e+002));       // S41
  test::check_near(agilent.value[16 + 9], from_db(-4.406099e+001, -1.641571e+002));  // S32 of the second point
}
