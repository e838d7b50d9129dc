#include "acquisition/wav_table.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "acquisition/riff.hpp"
#include "catch.hpp"
#include "read_whole.hpp"

using namespace bodeflow;
using namespace bodeflow::acquisition;
using test::read_file;
using test::Table;
using test::TemporaryFile;

namespace {

/// Interleaved values to a sound file.
void write_sound(const std::string& path, int format, const std::vector<double>& values, int channels = 1, int rate = 48000) {
  SF_INFO info{};
  info.format = format;
  info.channels = channels;
  info.samplerate = rate;
  SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
  REQUIRE(file != nullptr);
  const auto frames = static_cast<sf_count_t>(values.size()) / channels;
  const int coding = format & SF_FORMAT_SUBMASK;
  if (coding == SF_FORMAT_FLOAT || coding == SF_FORMAT_DOUBLE) {
    sf_writef_double(file, values.data(), frames);
  } else {  // as integers of 32 bits: the library's own scaling of doubles is not the inverse of what it reads
    std::vector<int> scaled;
    for (const double x : values) scaled.push_back(static_cast<int>(std::clamp(x * 2147483648.0, -2147483648.0, 2147483647.0)));
    sf_writef_int(file, scaled.data(), frames);
  }
  sf_close(file);
}

void append(std::string& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> static_cast<unsigned>(8 * i) & 0xFFU);
}

/// A WAV file of 16-bit samples with headers as stated.
std::string wav(const std::string& samples, std::uint32_t stated, unsigned channels = 1, unsigned format = 1,
                unsigned rate = 8000) {
  std::string bytes = "RIFF";
  append(bytes, 36 + stated, 4);
  bytes += "WAVEfmt ";
  append(bytes, 16, 4);
  append(bytes, format, 2);
  append(bytes, channels, 2);
  append(bytes, rate, 4);
  append(bytes, rate * channels * 2, 4);
  append(bytes, channels * 2, 2);
  append(bytes, 16, 2);
  bytes += "data";
  append(bytes, stated, 4);
  return bytes + samples;
}

/// Quarters of full scale: exact in every format.
std::vector<double> quarters(std::size_t count) {
  std::vector<double> x;
  for (std::size_t n = 0; n < count; ++n) x.push_back(0.25 * static_cast<double>(n % 7) - 0.75);
  return x;
}

}  // namespace

TEST_CASE("WAV: channels of every exact coding, scaled so that full scale is one") {
  const std::vector<double> x = quarters(3 * 500);
  std::vector<std::vector<double>> channels(3);
  for (std::size_t n = 0; n < x.size(); ++n) channels[n % 3].push_back(x[n]);
  for (const int format :
       {SF_FORMAT_WAV | SF_FORMAT_PCM_U8, SF_FORMAT_WAV | SF_FORMAT_PCM_16, SF_FORMAT_WAV | SF_FORMAT_PCM_24,
        SF_FORMAT_WAV | SF_FORMAT_PCM_32, SF_FORMAT_WAV | SF_FORMAT_FLOAT, SF_FORMAT_WAV | SF_FORMAT_DOUBLE,
        SF_FORMAT_WAVEX | SF_FORMAT_PCM_24, SF_FORMAT_RF64 | SF_FORMAT_PCM_16, SF_FORMAT_FLAC | SF_FORMAT_PCM_24}) {
    INFO(format);
    const TemporaryFile file((format & SF_FORMAT_TYPEMASK) == SF_FORMAT_FLAC ? ".flac" : ".wav");
    write_sound(file.path(), format, x, 3, 44100);
    const Table t = read_file(file.path());
    REQUIRE(t.error == "");
    REQUIRE(t.columns.size() == 3);
    CHECK(t.columns[2].header == "ch3");
    CHECK(t.summary.rate == Rate(44100, 1));
    CHECK(t.summary.rows == 500);
    CHECK(t.values == channels);
    CHECK(read_file(file.path(), {"ch2"}, {}, {400, 50, {}, {}}).values ==
          std::vector<std::vector<double>>{{channels[1].begin() + 400, channels[1].begin() + 450}});
  }
}

TEST_CASE("WAV: the scale is told, and clipping at full scale is seen") {
  const TemporaryFile integers(".wav"), floats(".wav");
  std::vector<double> x;
  for (int n = 0; n < 400; ++n) x.push_back(std::clamp(1.3 * std::sin(0.1 * n), -1.0, 32767.0 / 32768.0));
  write_sound(integers.path(), SF_FORMAT_WAV | SF_FORMAT_PCM_16, x);
  write_sound(floats.path(), SF_FORMAT_WAV | SF_FORMAT_FLOAT, x);
  const Table t = read_file(integers.path());
  CHECK(t.summary.remarks == std::vector<std::string>{"Signed 16 bit PCM, full scale is +-1"});
  CHECK(t.summary.columns[0].least == -1.0);
  CHECK(t.summary.columns[0].greatest == 32767.0 / 32768.0);
  CHECK(t.summary.columns[0].runs_at_greatest == 7);
  CHECK(read_file(floats.path()).summary.remarks == std::vector<std::string>{"32 bit float, values as stored"});
}

TEST_CASE("WAV: each kind of broken or surprising file is refused with its reason") {
  const TemporaryFile file(".wav");
  const auto error = [&file](const std::string& bytes) {
    file.write(bytes);
    return read_file(file.path()).error;
  };
  const std::string samples(100, '\1');
  CHECK(error(wav(samples, 100)) == "");
  CHECK(error(wav(samples, 400)) == "F: cut off: the header states 400 bytes of samples, the file holds 100");
  CHECK(error(wav(samples, 0)) ==
        "F: the header states no samples, but 100 bytes follow: the recording was broken off before its header was completed");
  CHECK(error(wav(samples, 0xFFFFFFFF)) == "F: the header was never completed: the recording was broken off");
  CHECK(error(wav("", 0)) == "F: no rows");
  CHECK(error(wav(samples, 100).substr(0, 30)) == "F: cut off: chunk 'fmt ' goes beyond the end of the file");
  CHECK(error(wav(samples, 100).substr(0, 36)) == "F: no chunk of samples in it");
  CHECK(error(wav(samples, 100, 0)) == "F: the header states 0 channels");
  CHECK(error(wav(samples, 100, 1, 1, 0)) == "F: the header states 0 samples per second");
  CHECK(error(wav(samples, 100, 1, 0x7777)).rfind("F: is no sound file that can be read: ", 0) == 0);
  CHECK(error("t,u\n0,1\n").rfind("F: is no sound file that can be read: ", 0) == 0);
  CHECK(error("") == "F: empty file");

  write_sound(file.path(), SF_FORMAT_WAV | SF_FORMAT_ALAW, quarters(100));
  CHECK(read_file(file.path()).error ==
        "F: is coded as A-Law, which loses digits; read are integers of 8 to 32 bits and floating-point numbers");
  write_sound(file.path(), SF_FORMAT_WAV | SF_FORMAT_IMA_ADPCM, quarters(4000));
  CHECK(read_file(file.path()).error ==
        "F: is coded as IMA ADPCM, which loses digits; read are integers of 8 to 32 bits and floating-point numbers");
  write_sound(file.path(), SF_FORMAT_WAV | SF_FORMAT_DOUBLE, {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()});
  CHECK(read_file(file.path()).error == "F: row 3: column 'ch1': nan is not finite");
  write_sound(file.path(), SF_FORMAT_RF64 | SF_FORMAT_PCM_16, quarters(100));
  CHECK(error(file.bytes().substr(0, 200)) == "F: cut off: the header states 200 bytes of samples, the file holds 96");
}

TEST_CASE("WAV: the rate of the file and a stated one must agree") {
  const TemporaryFile file(".wav");
  write_sound(file.path(), SF_FORMAT_WAV | SF_FORMAT_PCM_16, quarters(100));
  CHECK(read_file(file.path(), {}, {44100.0, false, "", ""}).error ==
        "F: the file states 48000 Hz, parameter rate says 44100 Hz; time: ignore reads the file by the rate alone");
  CHECK(read_file(file.path(), {}, {44100.0, true, "", ""}).summary.rate == Rate(44100, 1));
  CHECK(read_file(file.path(), {"ch2"}).error == "no column 'ch2'; the file has ch1 (did you mean 'ch1'?)");
}
