#include "acquisition/mat_table.hpp"

#include <matio.h>

#include <algorithm>

#include "catch.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::read_file;
using test::Table;
using test::TemporaryFile;

namespace {

const Timing kAt10Hz{10.0, false, "", ""};

std::vector<double> ramp(std::size_t count, double first = 0.0, double step = 1.0) {
  std::vector<double> x(count);
  for (std::size_t n = 0; n < count; ++n) x[n] = first + step * static_cast<double>(n);
  return x;
}

/// Writes MATLAB v5 files for tests.
class MatWriter {
 public:
  MatWriter(const std::string& path, matio_compression compression = MAT_COMPRESSION_NONE)
      : file_(Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5)), compression_(compression) {}
  ~MatWriter() { Mat_Close(file_); }
  MatWriter(const MatWriter&) = delete;
  MatWriter& operator=(const MatWriter&) = delete;

  template <class T>
  static matvar_t* array(const char* name, matio_classes kind, matio_types type, const std::vector<T>& values,
                         std::vector<std::size_t> shape, int options = 0) {
    std::vector<T> copy = values;  // the library copies too, but asks for what it may write
    return Mat_VarCreate(name, kind, type, static_cast<int>(shape.size()), shape.data(), copy.data(), options);
  }
  static matvar_t* doubles(const char* name, const std::vector<double>& values, std::vector<std::size_t> shape) {
    return array(name, MAT_C_DOUBLE, MAT_T_DOUBLE, values, std::move(shape));
  }
  MatWriter& put(matvar_t* variable) {
    Mat_VarWrite(file_, variable, compression_);
    Mat_VarFree(variable);
    return *this;
  }
  MatWriter& put(const char* name, const std::vector<double>& values, std::vector<std::size_t> shape) {
    return put(doubles(name, values, std::move(shape)));
  }
  MatWriter& put(const char* name, const std::vector<double>& values) { return put(name, values, {values.size(), 1}); }

 private:
  mat_t* file_;
  matio_compression compression_;
};

template <class Write>
std::string refusal(Write write, const std::vector<std::string>& names = {}) {
  const TemporaryFile file(".mat");
  {
    MatWriter to(file.path());
    write(to);
  }
  return read_file(file.path(), names, kAt10Hz).error;
}

void append(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> static_cast<unsigned>(shift) & 0xFFU);
}

/// A file as a big-endian machine writes it: u = [1; 2; 3] as 16-bit integers.
std::string big_endian_file() {
  std::string bytes = "MATLAB 5.0 MAT-file, Platform: SOL2";
  bytes.resize(124, ' ');
  bytes += std::string("\1\0MI", 4);
  const std::uint32_t element[] = {14, 64, 6, 8, 10, 0, 5, 8, 3, 1, 1, 1};  // matrix; flags int16; dimensions 3 x 1; name
  for (const std::uint32_t word : element) append(bytes, word);
  bytes += std::string("u\0\0\0\0\0\0\0", 8);
  append(bytes, 3);  // int16
  append(bytes, 6);
  bytes += std::string("\0\1\0\2\0\3\0\0", 8);
  return bytes;
}

}  // namespace

TEST_CASE("MATLAB v5: vectors, matrices, types and structs, with and without compression, at the rate that Ts states") {
  for (const matio_compression compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    const TemporaryFile file(".mat");
    {
      MatWriter w(file.path(), compression);
      w.put("u", ramp(500)).put("row", ramp(500), {1, 500}).put("y", ramp(1500), {500, 3}).put("Ts", {0.0004});
      std::vector<float> singles(500, 0.5F);
      std::vector<std::int16_t> shorts(500, -7);
      std::vector<std::uint8_t> bytes(500, 200);
      w.put(MatWriter::array("single", MAT_C_SINGLE, MAT_T_SINGLE, singles, {500, 1}));
      w.put(MatWriter::array("short", MAT_C_INT16, MAT_T_INT16, shorts, {500, 1}));
      w.put(MatWriter::array("byte", MAT_C_UINT8, MAT_T_UINT8, bytes, {500, 1}));
      const char* fields[] = {"x", "fast"};
      const char* inner[] = {"z", "Fs"};
      matvar_t* deep = Mat_VarCreateStruct("fast", 2, std::vector<std::size_t>{1, 1}.data(), inner, 2);
      Mat_VarSetStructFieldByName(deep, "z", 0, MatWriter::doubles("z", ramp(300, 3.0), {300, 1}));
      Mat_VarSetStructFieldByName(deep, "Fs", 0, MatWriter::doubles("Fs", {48000.0}, {1, 1}));
      matvar_t* s = Mat_VarCreateStruct("s", 2, std::vector<std::size_t>{1, 1}.data(), fields, 2);
      Mat_VarSetStructFieldByName(s, "x", 0, MatWriter::doubles("x", ramp(200, 9.0), {200, 1}));
      Mat_VarSetStructFieldByName(s, "fast", 0, deep);
      w.put(s);
    }
    INFO(compression);
    const Table t = read_file(file.path(), {"u", "y[3]", "row", "single", "short", "byte"});
    REQUIRE(t.error == "");
    CHECK(t.summary.rate == Rate(2500, 1));
    CHECK(t.values[0] == ramp(500));
    CHECK(t.values[1] == ramp(500, 1000.0));
    CHECK(t.values[2] == ramp(500));
    CHECK(t.values[3] == std::vector<double>(500, 0.5));
    CHECK(t.values[4] == std::vector<double>(500, -7.0));
    CHECK(t.values[5] == std::vector<double>(500, 200.0));
    CHECK(read_file(file.path(), {"s.x"}, kAt10Hz).values == std::vector<std::vector<double>>{ramp(200, 9.0)});
    const Table deep = read_file(file.path(), {"s.fast.z"});
    CHECK(deep.error == "");
    CHECK(deep.summary.rate == Rate(48000, 1));
    CHECK(deep.values == std::vector<std::vector<double>>{ramp(300, 3.0)});
    CHECK(read_file(file.path(), {"u"}, {}, {100, 5, {}, {}}).values == std::vector<std::vector<double>>{ramp(5, 100.0)});
  }
}

TEST_CASE("MATLAB v5: a time vector whose unit is stated gives the rate") {
  const TemporaryFile file(".mat");
  MatWriter(file.path()).put("t", ramp(100, 0.0, 0.5)).put("u", ramp(100));
  CHECK(read_file(file.path(), {"u"}, {std::nullopt, false, "", "ms"}).summary.rate == Rate(2000, 1));
  CHECK(
      read_file(file.path(), {"u"}).error ==
      "F: no sampling rate and no time column (`t` or `time` with a unit of time, such as `t [s]`); give the sampling rate, such "
      "as rate: 2500 Hz, or if 't' holds time its unit, such as time_unit: s");
}

TEST_CASE("MATLAB v5: a file of a big-endian machine is read") {
  const TemporaryFile file(".mat", big_endian_file());
  const Table t = read_file(file.path(), {}, kAt10Hz);
  CHECK(t.error == "");
  CHECK(t.values == std::vector<std::vector<double>>{{1, 2, 3}});
}

TEST_CASE("MATLAB v5: each kind of variable that is no column is refused with its reason") {
  const auto with = [](matvar_t* (*make)()) { return [make](MatWriter& w) { w.put("u", ramp(5)).put(make()); }; };
  CHECK(refusal(
            with([] {
              std::vector<double> re = ramp(5), im = ramp(5);
              mat_complex_split_t z{re.data(), im.data()};
              return Mat_VarCreate("z", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, std::vector<std::size_t>{5, 1}.data(), &z, MAT_F_COMPLEX);
            }),
            {"z"}) == "'z' is complex; store its real and imaginary part as columns of their own");
  CHECK(refusal(with([] {
                  matvar_t* cells[] = {MatWriter::doubles(nullptr, ramp(5), {5, 1})};
                  return Mat_VarCreate("c", MAT_C_CELL, MAT_T_CELL, 2, std::vector<std::size_t>{1, 1}.data(), cells, 0);
                }),
                {"c"}) == "'c' is a cell array; store its parts as arrays");
  CHECK(refusal(with([] {
                  std::string text = "bench";
                  return Mat_VarCreate("note", MAT_C_CHAR, MAT_T_UTF8, 2, std::vector<std::size_t>{1, 5}.data(), text.data(), 0);
                }),
                {"note"}) == "'note' is text");
  CHECK(refusal(with([] {
                  mat_sparse_t sparse{};
                  mat_uint32_t row[] = {0, 3}, column[] = {0, 2};
                  double values[] = {1.0, 2.0};
                  sparse.nzmax = sparse.nir = sparse.ndata = 2;
                  sparse.ir = row;
                  sparse.njc = 2;
                  sparse.jc = column;
                  sparse.data = values;
                  return Mat_VarCreate("sp", MAT_C_SPARSE, MAT_T_DOUBLE, 2, std::vector<std::size_t>{5, 1}.data(), &sparse, 0);
                }),
                {"sp"}) == "'sp' is sparse; store it as a full array");
  CHECK(refusal(with([] { return MatWriter::doubles("none", {}, {0, 0}); }), {"none"}) == "'none' is empty");
  CHECK(refusal(with([] {
                  return MatWriter::doubles("gain", {2.0}, {1, 1});
                }),
                {"gain"}) == "'gain' is a single number, no column");
  CHECK(refusal(with([] {
                  return MatWriter::doubles("cube", ramp(8), {2, 2, 2});
                }),
                {"cube"}) == "'cube' has 3 dimensions; read are one or two");
  CHECK(refusal(with([] {
                  const char* fields[] = {"x"};
                  return Mat_VarCreateStruct("runs", 2, std::vector<std::size_t>{1, 2}.data(), fields, 1);
                }),
                {"runs"}) == "'runs' is an array of structs; store its parts as arrays");
  CHECK(refusal([](MatWriter& w) { w.put("gain", {2.0}); }) ==
        "F: no array that can be a column: 'gain' is a single number, no column");
  CHECK(refusal([](MatWriter&) {}) == "F: no array that can be a column");
  CHECK(refusal([](MatWriter& w) { w.put("u", ramp(5)).put("y", ramp(4)); }) ==
        "F: columns of different length: 'u' has 5 rows, 'y' has 4; name columns of one length");
  CHECK(refusal([](MatWriter& w) { w.put("u", {0.0, 1.0 / 0.0, 2.0}); }) == "F: row 2: column 'u': inf is not finite");
  CHECK(refusal([](MatWriter& w) { w.put("u", ramp(5)).put("Ts", {0.5}); }) ==
        "F: the file states 2 Hz, parameter rate says 10 Hz; time: ignore reads the file by the rate alone");
  CHECK(refusal([](MatWriter& w) { w.put("u", ramp(5)).put("Ts", {0.5}).put("Fs", {3.0}); }) ==
        "F: 'Ts' and 'Fs' state different sampling rates");
}

TEST_CASE("MATLAB: files of another kind, cut off or damaged are refused") {
  const TemporaryFile file(".mat");
  const auto error = [&file](const std::string& bytes) {
    file.write(bytes);
    return read_file(file.path(), {}, kAt10Hz).error;
  };
  CHECK(error("") == "F: empty file");
  CHECK(error("t,u\n0,1\n1,2\n2,3\n3,4\n4,5\n") == "F: is not a MATLAB file");
  CHECK(error("MATLAB 5.0 MAT-file") == "F: cut off in its header");
  std::string v4;
  for (const char word : {'\0', '\3', '\1', '\0', '\2'}) v4 += std::string(1, word) + std::string(3, '\0');
  CHECK(error(v4 + std::string("u\0", 2) + std::string(24, '\0')) == "F: is a MATLAB v4 file; save it with -v7 or -v7.3");

  MatWriter(file.path()).put("u", ramp(100));
  const std::string whole = file.bytes();
  CHECK(error(whole.substr(0, 200)) ==
        "F: cut off: variable 1 needs " + std::to_string(whole.size() - 136) + " bytes, 64 follow");
  CHECK(error(whole + "xy") == "F: cut off in the header of variable 2");
  CHECK(error(whole + "xyzwabcd") == "F: damaged: variable 2 begins with an element of type 2004515192, no array");
  std::string v73 = whole;
  v73.replace(124, 4, std::string("\0\2IM", 4));
  CHECK(error(v73) == "F: is not an HDF5 file");
  CHECK(open_mat([&file] { return open_file(file.path()); }, "F").error().text == "F: is of MATLAB's kind v7.3");

  std::string short_values = whole;  // the values claim to be 8 bytes
  const auto values = whole.find(std::string("\x09\0\0\0\x20\x03\0\0", 8));
  REQUIRE(values != std::string::npos);
  short_values.replace(values + 4, 4, std::string("\x08\0\0\0", 4));
  CHECK(error(short_values) == "F: variable 'u' is damaged: its values take 8 bytes, 800 are needed");
  std::string wrong_type = whole;
  wrong_type[values] = 16;
  CHECK(error(wrong_type) == "F: variable 'u' is damaged: its values have the type 16, no numbers");
  std::string long_values = whole;
  long_values.replace(values + 4, 4, std::string("\x28\x03\0\0", 4));
  CHECK(error(long_values) == "F: variable 'u' is damaged: an element goes beyond its array");

  MatWriter(file.path(), MAT_COMPRESSION_ZLIB).put("u", ramp(4000));
  const std::string compressed = file.bytes();
  std::string scrambled = compressed, wrong_sum = compressed, zeroed = compressed;
  for (std::size_t i = compressed.size() - 400; i < compressed.size() - 300; ++i) scrambled[i] = static_cast<char>(0x55);
  CHECK(error(scrambled).rfind("F: variable 'u' is damaged: its compressed bytes are damaged", 0) == 0);
  wrong_sum.back() = static_cast<char>(wrong_sum.back() ^ 1);
  CHECK(error(wrong_sum) == "F: variable 'u' is damaged: its compressed bytes are damaged: incorrect data check");
  zeroed.replace(136, 8, std::string(8, '\0'));
  CHECK(error(zeroed) == "F: a variable is damaged: its compressed bytes are damaged: unknown compression method");
  std::string ended = compressed;  // the file ends well, but the stream in it does not
  const std::size_t left = 300;
  ended.resize(136 + left);
  for (int i = 0; i < 4; ++i)
    ended[static_cast<std::size_t>(132 + i)] = static_cast<char>(left >> static_cast<unsigned>(8 * i) & 0xFFU);
  CHECK(error(ended) == "F: variable 'u' is damaged: its compressed bytes end too early");
}

TEST_CASE("MATLAB v5: no damaged byte crashes the reader, and under compression none changes a value") {
  const TemporaryFile file(".mat");
  for (const matio_compression compression : {MAT_COMPRESSION_NONE, MAT_COMPRESSION_ZLIB}) {
    {
      MatWriter w(file.path(), compression);
      const char* fields[] = {"x"};
      matvar_t* s = Mat_VarCreateStruct("s", 2, std::vector<std::size_t>{1, 1}.data(), fields, 1);
      Mat_VarSetStructFieldByName(s, "x", 0, MatWriter::doubles("x", ramp(8), {8, 1}));
      w.put("u", ramp(16), {8, 2}).put(s);
    }
    const std::string whole = file.bytes();
    const Table right = read_file(file.path(), {}, kAt10Hz);
    REQUIRE(right.values.size() == 3);
    for (std::size_t i = 128; i < whole.size(); ++i) {
      for (const int flip : {0x01, 0x80, 0xFF}) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ flip);
        const auto open = [&damaged] { return Expected<std::unique_ptr<ByteSource>>(open_memory(damaged)); };
        const Table t = test::read_whole(open_mat(open, "F"), {}, kAt10Hz);
        if (compression == MAT_COMPRESSION_NONE || !t.error.empty()) continue;
        for (const auto& column : t.values) CHECK(std::count(right.values.begin(), right.values.end(), column) > 0);
      }
    }
  }
}
