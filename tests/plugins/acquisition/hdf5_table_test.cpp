#include "acquisition/hdf5_table.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <thread>

#include "catch.hpp"
#include "hdf5_writer.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::Hdf5Writer;
using test::read_file;
using test::Table;
using test::TemporaryFile;

namespace {

const Timing kAt10Hz{10.0, false, "", ""};
const Timing kNone{};

std::vector<double> ramp(std::size_t count, double first = 0.0, double step = 1.0) {
  std::vector<double> x(count);
  for (std::size_t n = 0; n < count; ++n) x[n] = first + step * static_cast<double>(n);
  return x;
}

/// What is said of a file that `write` made.
template <class Write>
std::string refusal(Write write, const std::vector<std::string>& names = {}, const Timing& timing = kAt10Hz,
                    const Part& part = {}) {
  const TemporaryFile file(".h5");
  {
    Hdf5Writer to(file.path());
    write(to);
  }
  return read_file(file.path(), names, timing, part).error;
}

hid_t complex_type() {
  const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
  H5Tinsert(type, "r", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "i", 8, H5T_NATIVE_DOUBLE);
  return type;
}

}  // namespace

TEST_CASE("HDF5: data sets, columns of arrays, units and the rate of a group") {
  const TemporaryFile file(".h5");
  Hdf5Writer(file.path())
      .put("bench/current", ramp(20), {20}, H5T_STD_I16BE)
      .put("bench/angles", ramp(60), {20, 3}, H5T_IEEE_F32LE, {7, 2})
      .put("bench/one", ramp(20), {20, 1})
      .attribute("bench/current", "unit", "A")
      .attribute("bench/angles", "units", "rad")
      .attribute("bench", "sample_rate", 2500.0);
  const Table t = read_file(file.path());
  REQUIRE(t.error == "");
  REQUIRE(t.columns.size() == 5);
  CHECK(t.columns[0].header == "bench/angles[1]");
  CHECK(t.columns[2].header == "bench/angles[3]");
  CHECK(t.columns[2].unit == "rad");
  CHECK(t.columns[3].header == "bench/current");
  CHECK(t.columns[3].unit == "A");
  CHECK(t.columns[4].header == "bench/one");
  CHECK(t.summary.rate == Rate(2500, 1));
  CHECK(t.summary.origin == RateOrigin::file);
  CHECK(t.values[0] == ramp(20, 0.0, 3.0));
  CHECK(t.values[2] == ramp(20, 2.0, 3.0));
  CHECK(t.values[3] == ramp(20));
  const Table some = read_file(file.path(), {"bench/one", "bench/angles[3]", "bench/angles[2]"});
  REQUIRE(some.error == "");
  CHECK(some.values == std::vector<std::vector<double>>{ramp(20), ramp(20, 2.0, 3.0), ramp(20, 1.0, 3.0)});
}

TEST_CASE("HDF5: a time column beside the data gives the rate; of several groups it is the one of the data") {
  const TemporaryFile file(".h5");
  Hdf5Writer(file.path())
      .put("a/t", ramp(50, 0.0, 0.01))
      .put("a/x", ramp(50))
      .put("b/time", ramp(80, 3.0, 2.0))
      .put("b/x", ramp(80, 5.0))
      .attribute("a/t", "unit", "s")
      .attribute("b/time", "unit", "ms");
  CHECK(read_file(file.path(), {"a/x"}).summary.rate == Rate(100, 1));
  const Table b = read_file(file.path(), {"b/x"});
  CHECK(b.summary.rate == Rate(500, 1));
  CHECK(b.values[0] == ramp(80, 5.0));
  CHECK(read_file(file.path(), {"b/x"}, {std::nullopt, false, "b/time", ""}).summary.rate == Rate(500, 1));
  CHECK(read_file(file.path(), {"a/x"}, {std::nullopt, false, "b/x", ""}).error ==
        "F: time_column: 'b/x' has no unit; state it, such as time_unit: s");
}

TEST_CASE("HDF5: each kind of broken or surprising file is refused with its reason") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  CHECK(
      refusal([](Hdf5Writer& w) { w.put("x", ramp(5)); }, {}, kNone) ==
      "F: no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the sampling rate, such "
      "as rate: 2500 Hz");
  CHECK(
      refusal([](Hdf5Writer& w) { w.put("t", ramp(5)).put("x", ramp(5)); }, {"x"}, kNone) ==
      "F: no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the sampling rate, such "
      "as rate: 2500 Hz, or if 't' holds time its unit, such as time_unit: s");
  CHECK(refusal([](Hdf5Writer& w) { w.put("drive/speed", ramp(5)).put("drive/torque", ramp(5)); }, {"drive/sped"}) ==
        "no column 'drive/sped'; the file has drive/speed, drive/torque (did you mean 'drive/speed'?)");
  CHECK(refusal(
            [](Hdf5Writer& w) {
              w.put("x", ramp(5)).put("m", ramp(10), {5, 2});
            },
            {"m"}) == "'m' has several columns: m[1], m[2] ...; say which");
  CHECK(refusal(
            [](Hdf5Writer& w) {
              w.put("x", ramp(5)).put("cube", ramp(24), {2, 3, 4});
            },
            {"cube"}) == "'cube' has 3 dimensions (2 x 3 x 4); read are one or two");
  CHECK(refusal([](Hdf5Writer& w) { w.put("x", ramp(5)).put("gain", {2.0}, {}); }, {"gain"}) ==
        "'gain' is a single number, no column");
  CHECK(refusal([](Hdf5Writer& w) { w.put("x", ramp(5)).put_empty("note", H5T_C_S1, {5}); }, {"note"}) == "'note' is text");
  CHECK(refusal([](Hdf5Writer& w) { w.put("x", ramp(5)).put("none", {}, {0}); }, {"none"}) == "'none' is empty");
  CHECK(refusal([](Hdf5Writer& w) { w.put("none", {}, {0}); }) == "F: no data set that can be a column: 'none' is empty");
  CHECK(refusal([](Hdf5Writer&) {}) == "F: no data set that can be a column");
  CHECK(refusal([](Hdf5Writer& w) { w.put("x", ramp(5)).put_empty("z", complex_type(), {5}); }, {"z"}) ==
        "'z' is complex; store its real and imaginary part as columns of their own");
  CHECK(refusal(
            [](Hdf5Writer& w) {
              const hid_t type = H5Tcreate(H5T_COMPOUND, 16);
              H5Tinsert(type, "time", 0, H5T_NATIVE_DOUBLE);
              H5Tinsert(type, "speed", 8, H5T_NATIVE_DOUBLE);
              w.put("x", ramp(5)).put_empty("log", type, {5});
            },
            {"log"}) == "'log' is a table with the fields time, speed; store each field as a data set of its own");
  CHECK(refusal(
            [](Hdf5Writer& w) {
              const hid_t type = H5Tenum_create(H5T_NATIVE_INT8);
              const signed char no = 0;
              H5Tenum_insert(type, "FALSE", &no);
              w.put("x", ramp(5)).put_empty("on", type, {5});
            },
            {"on"}) == "'on' holds names or truth values (an enumeration), no numbers");
  CHECK(refusal([](Hdf5Writer& w) { w.put("x", ramp(5)).put_empty("link", H5T_STD_REF_OBJ, {5}); }, {"link"}) ==
        "'link' holds references, no numbers");
  CHECK(refusal(
            [](Hdf5Writer& w) {
              w.put("x", ramp(5)).put("wide", ramp(10000), {2, 5000});
            },
            {"wide"}) == "'wide' has 5000 columns and 2 rows; is it stored the other way round? (read are up to 4096 columns)");
  CHECK(refusal([](Hdf5Writer& w) { w.put("u", ramp(100)).put("y", ramp(90)); }) ==
        "F: columns of different length: 'u' has 100 rows, 'y' has 90; name columns of one length");
  CHECK(refusal([](Hdf5Writer& w) {
          w.put("u", ramp(9)).put("y", ramp(9)).attribute("u", "rate", 100.0).attribute("y", "rate", 200.0);
        }) == "F: two sampling rates: 'u' has 100 Hz, 'y' has 200 Hz; read each with a block of its own");
  CHECK(refusal([](Hdf5Writer& w) { w.put("u", ramp(9)).attribute("u", "rate", 100.0); }) ==
        "F: the file states 100 Hz, parameter rate says 10 Hz; time: ignore reads the file by the rate alone");
  CHECK(refusal([](Hdf5Writer& w) { w.put("u", ramp(9)).attribute("u", "rate", -1.0); }) ==
        "F: attribute 'rate' of 'u' is no sampling rate: -1");
  CHECK(refusal([&](Hdf5Writer& w) {
          w.put("u", {1, 2, 3, 4}).put("y", {1, 2, nan, infinity});
        }) == "F: row 3: column 'y': nan is not finite");
  CHECK(refusal([&](Hdf5Writer& w) {
          w.put("u", {1, -infinity, 3, 4}).put("y", {1, 2, nan, 4});
        }) == "F: row 2: column 'u': -inf is not finite");
  CHECK(refusal(
            [](Hdf5Writer& w) {
              w.put("t", {0, 1, 2, 5, 6}).put("u", ramp(5)).attribute("t", "unit", "s");
            },
            {}, kNone) == "F: row 4: gap of 2 samples after 2 s: a step of 3 s where samples are 1 s apart");
  CHECK(refusal(
            [](Hdf5Writer& w) {
              w.put("t", {0, 1, 1, 2}).put("u", ramp(4)).attribute("t", "unit", "s");
            },
            {}, kNone) == "F: row 3: time 1 s stands twice");
  CHECK(refusal(
            [&](Hdf5Writer& w) {
              w.put("t", {0, 1, nan, 3}).put("u", ramp(4)).attribute("t", "unit", "s");
            },
            {}, kNone) == "F: row 3: column 't': nan is not finite");
  CHECK(refusal(
            [](Hdf5Writer& w) { w.put("t", ramp(9)).put("u", ramp(9)).attribute("t", "unit", "s").attribute("u", "rate", 2.0); },
            {}, kNone) == "F: the time column says 1 Hz, the file states 2 Hz; time: ignore reads the file by the rate alone");
  CHECK(refusal([](Hdf5Writer& w) { w.put("t", ramp(4)).attribute("t", "unit", "s"); }, {"t"}, kNone) == "");
}

TEST_CASE("HDF5: values behind a filter that is not there are refused with its name") {
  constexpr H5Z_filter_t kFilter = 300;  // of the range for tests
  const H5Z_class2_t same = {
      H5Z_CLASS_T_VERS,
      kFilter,
      1,
      1,
      "squeeze",
      nullptr,
      nullptr,
      [](unsigned, std::size_t, const unsigned*, std::size_t bytes, std::size_t*, void**) { return bytes; }};
  REQUIRE(H5Zregister(&same) >= 0);
  const TemporaryFile file(".h5");
  {
    Hdf5Writer w(file.path());
    w.put("x", ramp(50));
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t shape[] = {50}, chunk[] = {10};
    H5Pset_chunk(creation, 1, chunk);
    H5Pset_filter(creation, kFilter, H5Z_FLAG_OPTIONAL, 0, nullptr);
    const hid_t space = H5Screate_simple(1, shape, nullptr);
    const hid_t set = H5Dcreate2(w.id(), "y", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, ramp(50).data());
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(creation);
  }
  CHECK(read_file(file.path(), {"y"}, kAt10Hz).values == std::vector<std::vector<double>>{ramp(50)});
  REQUIRE(H5Zunregister(kFilter) >= 0);
  CHECK(read_file(file.path(), {"x"}, kAt10Hz).error == "");
  CHECK(read_file(file.path(), {"x", "y"}, kAt10Hz).error ==
        "F: data set 'y' is compressed with filter 'squeeze' (300), which is not available here; store it with gzip");
}

TEST_CASE("HDF5: data sets that were never written, or hardly, are refused") {
  const TemporaryFile file(".h5");
  {
    Hdf5Writer w(file.path());
    w.put_empty("flat", H5T_IEEE_F64LE, {100});
    const auto create = [&](const char* path, hsize_t rows, hsize_t written) {
      const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
      const hsize_t chunk[] = {10}, first[] = {0};
      H5Pset_chunk(creation, 1, chunk);
      const hid_t space = H5Screate_simple(1, &rows, nullptr);
      const hid_t set = H5Dcreate2(w.id(), path, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
      if (written > 0) {
        const hid_t memory = H5Screate_simple(1, &written, nullptr);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, first, nullptr, &written, nullptr);
        H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, ramp(written).data());
        H5Sclose(memory);
      }
      H5Dclose(set);
      H5Sclose(space);
      H5Pclose(creation);
    };
    create("none", 100, 0);
    create("sparse", hsize_t{10000000000000}, 20);
    create("half", 100, 20);
  }
  CHECK(read_file(file.path(), {"flat"}, kAt10Hz).error == "F: data set 'flat' holds no values: none was ever written");
  CHECK(read_file(file.path(), {"none"}, kAt10Hz).error == "F: data set 'none' holds no values: none was ever written");
  CHECK(read_file(file.path(), {"sparse"}, kAt10Hz).error ==
        "F: data set 'sparse' has 1000000000000 chunks of which all but 2 hold no values: they were never written");
  CHECK(read_file(file.path(), {"half"}, kAt10Hz).summary.rows == 100);
}

TEST_CASE("HDF5: names in the file reach messages as printable text") {
  const TemporaryFile file(".h5");
  Hdf5Writer(file.path()).put("x\x1B[31m", ramp(5)).put("T\xB0", ramp(5));
  const Table t = read_file(file.path(), {}, kAt10Hz);
  REQUIRE(t.columns.size() == 1);
  CHECK(t.columns[0].header == "x?[31m");
  CHECK(t.values == std::vector<std::vector<double>>{ramp(5)});
  CHECK(read_file(file.path(), {"T?"}, kAt10Hz).error == "'T?' has a name that is not UTF-8 text");
}

TEST_CASE("HDF5: files that are none, cut off or overwritten are refused") {
  const TemporaryFile text(".h5", "t [s],u [V]\n0,1\n"), empty(".h5", "");
  CHECK(read_file(text.path()).error == "F: is not an HDF5 file");
  CHECK(read_file(empty.path()).error == "F: empty file");
  CHECK(read_file("/nowhere/x.h5").error == "F: can't be opened: No such file or directory");

  const TemporaryFile file(".h5");
  Hdf5Writer(file.path()).put("x", ramp(20000), {20000}, H5T_IEEE_F64LE, {1000});
  const std::string whole = file.bytes();
  file.write(whole.substr(0, whole.size() / 2));
  const std::string error = read_file(file.path(), {}, kAt10Hz).error;
  CHECK(error.rfind("F: can't be opened: truncated file: eof = ", 0) == 0);

  std::string damaged = whole;  // in the middle of the compressed values
  for (std::size_t i = whole.size() / 2; i < whole.size() / 2 + 200; ++i) damaged[i] = static_cast<char>(0x5A);
  file.write(damaged);
  CHECK(read_file(file.path(), {}, kAt10Hz).error.rfind("F: values can't be read: ", 0) == 0);
}

TEST_CASE("HDF5: a part of the rows by number and by time") {
  const TemporaryFile file(".h5");
  Hdf5Writer(file.path()).put("u", ramp(1000)).attribute("u", "rate", 100.0);
  const auto part = [&](const Part& p) { return read_file(file.path(), {}, {}, p); };
  CHECK(part({250, 20, {}, {}}).values[0] == ramp(20, 250.0));
  CHECK(part({990, {}, {}, {}}).values[0] == ramp(10, 990.0));
  CHECK(part({0, {}, 2.5, 2.7}).values[0] == ramp(20, 250.0));
  CHECK(part({0, {}, {}, 0.03}).values[0] == ramp(3));
  CHECK(part({0, {}, 9.9, {}}).values[0] == ramp(10, 990.0));
  CHECK(part({0, {}, 9.9, 10.0}).values[0] == ramp(10, 990.0));
  CHECK(part({990, 11, {}, {}}).error == "F: rows 991 to 1001 are asked for, but the file ends before");
  CHECK(part({1000, {}, {}, {}}).error == "F: rows from 1001 on are asked for, but the file ends before");
  CHECK(part({0, {}, 9.9, 10.1}).error == "F: rows from 9.9 s to 10.1 s are asked for, but the file ends before");
  CHECK(part({0, {}, 20.0, {}}).error == "F: no rows from 20 s");
}

TEST_CASE("HDF5: a bad value outside of the part that is used does no harm") {
  const TemporaryFile file(".h5");
  auto x = ramp(100);
  x[10] = std::numeric_limits<double>::quiet_NaN();
  x[60] = std::numeric_limits<double>::infinity();
  Hdf5Writer(file.path()).put("u", x).put("t", ramp(100, 7.0, 0.5)).attribute("t", "unit", "s");
  CHECK(read_file(file.path(), {}, {}, {11, 49, {}, {}}).values[0] == ramp(49, 11.0));
  const Table t = read_file(file.path(), {}, {}, {0, {}, 13.0, 36.9});  // by the time column: rows 12 to 59
  CHECK(t.error == "");
  CHECK(t.summary.first_row == 12);
  CHECK(t.values[0] == ramp(48, 12.0));
  CHECK(read_file(file.path(), {}, {}, {5, {}, {}, {}}).error == "F: row 11: column 'u': nan is not finite");
  CHECK(read_file(file.path(), {}, {}, {20, {}, {}, {}}).error == "F: row 61: column 'u': inf is not finite");
}

TEST_CASE("HDF5: large chunks are read once, chunks beyond the bound are refused") {
  const TemporaryFile file(".h5");
  {
    Hdf5Writer w(file.path());
    w.put("x", ramp(300000), {300000}, H5T_IEEE_F64LE, {300000});
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    const hsize_t chunk[] = {std::size_t{40} << 20}, shape[] = {std::size_t{40} << 20};
    H5Pset_chunk(creation, 1, chunk);
    H5Pset_deflate(creation, 1);
    const hid_t space = H5Screate_simple(1, shape, nullptr);
    const hid_t huge = H5Dcreate2(w.id(), "huge", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    const char one = 0;  // a chunk whose bytes are nonsense: it is refused before they are read
    const hsize_t first[] = {0};
    H5Dwrite_chunk(huge, H5P_DEFAULT, 0, first, 1, &one);
    H5Dclose(huge);
    H5Sclose(space);
    H5Pclose(creation);
  }
  CHECK(read_file(file.path(), {"x"}, kAt10Hz).values[0] == ramp(300000));
  CHECK(
      read_file(file.path(), {"huge"}, kAt10Hz).error ==
      "F: data set 'huge' is stored in chunks of which 320 MiB are needed at a time; all columns together may need 256 MiB; read "
      "fewer columns, or store them in smaller chunks");
}

TEST_CASE("MATLAB v7.3: arrays stand the other way round, rows are columns, Ts states the rate of its struct") {
  const TemporaryFile file(".mat");
  {
    Hdf5Writer w(file.path(), 512);
    w.put("u", ramp(20), {20, 1}).put("r", ramp(20), {1, 20}).put("y", ramp(60), {3, 20}, H5T_IEEE_F64LE, {2, 7});
    w.put("s/x", ramp(20), {1, 20}).put("s/Ts", {0.0004}, {1, 1}).put("Ts", {0.01}, {1, 1});
    w.put("name", ramp(4), {4, 1}, H5T_STD_U16LE).put("cell", ramp(2), {2, 1}).put("empty", ramp(2), {2});
    for (const char* path : {"u", "r", "y", "s/x", "s/Ts", "Ts", "empty"}) w.attribute(path, "MATLAB_class", "double");
    w.attribute("name", "MATLAB_class", "char").attribute("cell", "MATLAB_class", "cell").attribute("empty", "MATLAB_empty", 1.0);
    w.put("S/data", ramp(5)).put("S/ir", ramp(5)).put("S/jc", ramp(5)).attribute("S", "MATLAB_sparse", 5.0);
  }
  std::string bytes = file.bytes();
  const std::string header = "MATLAB 7.3 MAT-file, Platform: GLNXA64";
  bytes.replace(0, header.size(), header);
  bytes.replace(124, 4, std::string("\0\2IM", 4));
  file.write(bytes);
  const Table t = read_file(file.path(), {"u", "r", "y[2]", "y[3]"});
  REQUIRE(t.error == "");
  CHECK(t.values == std::vector<std::vector<double>>{ramp(20), ramp(20), ramp(20, 20.0), ramp(20, 40.0)});
  CHECK(t.summary.rate == Rate(100, 1));
  const Table field = read_file(file.path(), {"s.x"});
  CHECK(field.values == std::vector<std::vector<double>>{ramp(20)});
  CHECK(field.summary.rate == Rate(2500, 1));
  CHECK(read_file(file.path()).error ==
        "F: two sampling rates: 'r' has 100 Hz, 's.x' has 2500 Hz; read each with a block of its own");
  CHECK(read_file(file.path(), {"name"}).error == "'name' is text");
  CHECK(read_file(file.path(), {"cell"}).error == "'cell' is a cell array; store its parts as arrays");
  CHECK(read_file(file.path(), {"empty"}).error == "'empty' is empty");
  CHECK(read_file(file.path(), {"S"}).error == "'S' is sparse; store it as a full array");
  CHECK(read_file(file.path(), {"S.data"}).error.rfind("no column 'S.data'; the file has ", 0) == 0);
}

TEST_CASE("HDF5: a failed read prints nothing and leaves the error printing of the program as it was") {
  H5E_auto2_t before = nullptr, after = nullptr;
  void* data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  const TemporaryFile text(".h5", "no HDF5");
  CHECK_FALSE(open_hdf5(text.path()));
  H5Eget_auto2(H5E_DEFAULT, &after, &data);
  CHECK(before == after);
}

TEST_CASE("HDF5: readers on several threads do not disturb each other or a writer") {
  const TemporaryFile file(".h5"), other(".h5"), written(".h5");
  Hdf5Writer(file.path()).put("x", ramp(40000), {40000}, H5T_IEEE_F64LE, {1000});
  Hdf5Writer(other.path()).put("x", ramp(40000, 5.0), {40000}, H5T_IEEE_F64LE, {777});
  std::vector<Table> read(2);
  std::thread first([&] { read[0] = read_file(file.path(), {}, kAt10Hz); });
  std::thread second([&] { read[1] = read_file(other.path(), {}, kAt10Hz); });
  for (int i = 0; i < 20; ++i) Hdf5Writer(written.path()).put("y", ramp(5000), {5000}, H5T_IEEE_F64LE, {500});
  first.join();
  second.join();
  CHECK(read[0].values[0] == ramp(40000));
  CHECK(read[1].values[0] == ramp(40000, 5.0));
  CHECK(read_file(written.path(), {}, kAt10Hz).values[0] == ramp(5000));
}
