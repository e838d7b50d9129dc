#include "sample_format.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace bodeflow::acquisition {
namespace {

struct Description {
  SampleFormat format;
  const char* name;
  std::size_t bytes;
  int bits;  ///< of an integer; 0: floating point
};
constexpr std::array<Description, 5> kFormats{{{SampleFormat::s16, "s16", 2, 16},
                                               {SampleFormat::s24, "s24", 4, 24},
                                               {SampleFormat::s24_3le, "s24_3le", 3, 24},
                                               {SampleFormat::s32, "s32", 4, 32},
                                               {SampleFormat::f32, "f32", 4, 0}}};

const Description& description(SampleFormat format) { return kFormats[static_cast<std::size_t>(format)]; }

std::uint32_t load(const std::uint8_t* at, std::size_t bytes) {
  std::uint32_t word = 0;
  for (std::size_t b = 0; b < bytes; ++b) word |= static_cast<std::uint32_t>(at[b]) << (8 * b);
  return word;
}

void store(std::uint8_t* at, std::size_t bytes, std::uint32_t word) {
  for (std::size_t b = 0; b < bytes; ++b) at[b] = static_cast<std::uint8_t>(word >> (8 * b));
}

/// The integer in the low `bits` of a word.
std::int32_t signed_of(std::uint32_t word, int bits) {
  const int above = 32 - bits;
  return static_cast<std::int32_t>(word << above) >> above;
}

float float_of(std::uint32_t word) {
  float value = 0.0F;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

}  // namespace

std::vector<std::string> sample_formats() {
  std::vector<std::string> names;
  for (const Description& d : kFormats) names.emplace_back(d.name);
  return names;
}

std::optional<SampleFormat> sample_format(std::string_view name) {
  for (const Description& d : kFormats)
    if (name == d.name) return d.format;
  return std::nullopt;
}

const char* name_of(SampleFormat format) { return description(format).name; }

std::size_t bytes_of(SampleFormat format) { return description(format).bytes; }

double step_of(SampleFormat format) {
  const int bits = description(format).bits;
  return std::ldexp(1.0, bits == 0 ? -24 : 1 - bits);
}

std::size_t decode(const Interleaved& layout, const ChannelScale& scale, const std::uint8_t* frames, std::span<double> values) {
  const auto [format, name, bytes, bits] = description(layout.format);
  const std::uint8_t* at = frames + layout.channel * bytes;
  std::size_t clipped = 0;
  if (bits == 0) {
    for (double& value : values) {
      const double reading = float_of(load(at, bytes));
      clipped += !(std::abs(reading) < 1.0);
      value = scale.gain * reading + scale.offset;
      at += layout.frame_bytes();
    }
    return clipped;
  }
  const double step = step_of(format);
  const auto lowest = static_cast<std::int32_t>(-(std::int64_t{1} << (bits - 1)));
  const auto highest = static_cast<std::int32_t>((std::int64_t{1} << (bits - 1)) - 1);
  for (double& value : values) {
    const std::int32_t code = signed_of(load(at, bytes), bits);
    clipped += code == lowest || code == highest;
    value = scale.gain * (step * code) + scale.offset;
    at += layout.frame_bytes();
  }
  return clipped;
}

std::size_t encode(const Interleaved& layout, const ChannelScale& scale, std::span<const double> values, std::uint8_t* frames) {
  const auto [format, name, bytes, bits] = description(layout.format);
  std::uint8_t* at = frames + layout.channel * bytes;
  std::size_t limited = 0;
  const double codes = bits == 0 ? 1.0 : std::ldexp(1.0, bits - 1);
  for (const double value : values) {
    const double wanted = (value - scale.offset) / scale.gain * codes;
    if (bits == 0) {
      const auto reading = static_cast<float>(std::clamp(wanted, -1.0, 1.0));
      limited += std::abs(wanted) > 1.0;
      std::uint32_t word = 0;
      std::memcpy(&word, &reading, sizeof word);
      store(at, bytes, word);
    } else {
      const double code = std::clamp(std::nearbyint(wanted), -codes, codes - 1.0);
      limited += code != std::nearbyint(wanted);
      store(at, bytes, static_cast<std::uint32_t>(static_cast<std::int32_t>(code)));
    }
    at += layout.frame_bytes();
  }
  return limited;
}

}  // namespace bodeflow::acquisition
