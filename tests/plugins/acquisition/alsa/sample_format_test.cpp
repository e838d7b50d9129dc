#include "acquisition/alsa/sample_format.hpp"

#include <array>
#include <cmath>

#include "catch.hpp"

using namespace bodeflow::acquisition;

namespace {

/// What a value becomes on its way through a format, in the second of three channels.
double there_and_back(SampleFormat format, double value, const ChannelScale& scale, std::size_t& limited) {
  std::array<std::uint8_t, 2 * 3 * 4> bytes{};
  const Interleaved layout{format, 3, 1};
  const std::array<double, 2> in{value, value};
  std::array<double, 2> out{};
  limited = encode(layout, scale, in, bytes.data());
  decode(layout, scale, bytes.data(), out);
  CHECK(out[0] == out[1]);
  return out[0];
}

}  // namespace

TEST_CASE("samples pass each format to within half of its step and are limited at full scale") {
  for (const std::string& name : sample_formats()) {
    INFO(name);
    const SampleFormat format = *sample_format(name);
    const double step = step_of(format);
    const ChannelScale volts{2.5, 0.125, "V"};
    std::size_t limited = 0;
    for (const double reading : {0.0, 0.3, -0.7, 1 / 3.0, -1.0, 1.0 - step}) {
      const double value = 2.5 * reading + 0.125;
      CHECK(std::abs(there_and_back(format, value, volts, limited) - value) <= 2.5 * (0.5 * step + 1e-16) + 1e-15);
      CHECK(limited == 0);
    }
    CHECK(there_and_back(format, 9.0, volts, limited) == Approx(2.5 * (format == SampleFormat::f32 ? 1.0 : 1.0 - step) + 0.125));
    CHECK(limited == 2);
    CHECK(there_and_back(format, -9.0, volts, limited) == Approx(-2.5 + 0.125));
    CHECK(limited == 2);
  }
}

TEST_CASE("integer codes stand little-endian with their sign") {
  std::array<std::uint8_t, 4> bytes{};
  const std::array<double, 1> value{-0x1p-15};
  encode({SampleFormat::s16, 1, 0}, {}, value, bytes.data());
  CHECK(bytes == std::array<std::uint8_t, 4>{0xFF, 0xFF, 0, 0});
  encode({SampleFormat::s24_3le, 1, 0}, {}, value, bytes.data());
  CHECK(bytes == std::array<std::uint8_t, 4>{0x00, 0xFF, 0xFF, 0});
  encode({SampleFormat::s24, 1, 0}, {}, value, bytes.data());
  CHECK(bytes == std::array<std::uint8_t, 4>{0x00, 0xFF, 0xFF, 0xFF});
  const std::array<std::uint8_t, 4> low_three{0x00, 0x00, 0x80, 0x00};  // the fourth byte of s24 says nothing
  std::array<double, 1> read{};
  CHECK(decode({SampleFormat::s24, 1, 0}, {}, low_three.data(), read) == 1);
  CHECK(read[0] == -1.0);
}
