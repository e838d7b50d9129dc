#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/device/calibration.hpp"

namespace bodeflow::acquisition {

/// How a device codes a sample, little-endian.
enum class SampleFormat {
  s16,
  s24,      ///< the low three bytes of four
  s24_3le,  ///< three bytes
  s32,
  f32
};

/// The names that graphs use: s16, s24, s24_3le, s32, f32.
std::vector<std::string> sample_formats();
std::optional<SampleFormat> sample_format(std::string_view name);
const char* name_of(SampleFormat format);

std::size_t bytes_of(SampleFormat format);

/// The step between neighbouring codes, full scale being 1; 2^-24 for f32.
double step_of(SampleFormat format);

/// Samples of one channel among interleaved frames.
struct Interleaved {
  SampleFormat format = SampleFormat::s32;
  std::size_t channels = 1;
  std::size_t channel = 0;

  std::size_t frame_bytes() const { return channels * bytes_of(format); }
};

/// Writes gain * reading + offset of each frame to `values`; readings are -1 .. 1 of full scale. How many stand at the lowest
/// or the highest code: clipped, most likely.
std::size_t decode(const Interleaved& layout, const ChannelScale& scale, const std::uint8_t* frames, std::span<double> values);

/// Writes round((value - offset) / gain / step) into each frame, limited to the codes that there are. How many were limited.
/// Precondition: finite values.
std::size_t encode(const Interleaved& layout, const ChannelScale& scale, std::span<const double> values, std::uint8_t* frames);

}  // namespace bodeflow::acquisition
